"""A planner or an image runs on the host of a fast control loop.

Planning and vision take every core for tens of milliseconds, and caches and memory with them. A loop that answers the
robot within a millisecond misses its answer, and the robot stops.

Example that is reported:

```yaml
control: {update_rate: 1000 Hz}  # expect: refused-update-rate at update_rate
# expect at nodes.move_group.host
# expect at nodes.perception.host
```

Example that is accepted:

```yaml
control: {update_rate: 500 Hz}
```

Fix: run it on another computer of the cell.

Source: docs/principles.md#the-control-link
"""

from __future__ import annotations

from cellc.compiler.cell.interface import Node
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_FAST_HZ = 1000.0
_PLANNERS = frozenset({"moveit_ros_move_group", "moveit_servo", "nav2_planner"})
_IMAGES = ("/Image", "/CompressedImage", "/PointCloud2")


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield planners and readers of images on the host of a loop of 1 kHz or more that a device requires."""
    readers = {
        sink.full_name
        for interface in graph.cell.interfaces
        if interface.type.endswith(_IMAGES)
        for sink in interface.sinks
    }
    fast = {manager.host: manager for manager in graph.cell.managers if manager.update_rate_hz >= _FAST_HZ}
    for node in graph.cell.nodes:
        manager = fast.get(node.host)
        if manager is None or not node.host or not (node.package in _PLANNERS or node.full_name in readers):
            continue
        message = f"`{node.name}` {_does(node)} and must not run on `{node.host}`, beside a loop of"
        related = (Related("the loop", graph.cell.locate("control", "update_rate")),)
        yield found(graph, (*node.path, "host"), f"{message} {manager.update_rate_hz:g} Hz", related=related)


def _does(node: Node) -> str:
    return "plans" if node.package in _PLANNERS else "reads images"
