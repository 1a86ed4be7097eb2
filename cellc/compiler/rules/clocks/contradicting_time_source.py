"""A topic claims another time source than its publisher has.

A topic that is said to carry hardware stamps, from a driver that stamps on arrival, hides the delay that the stamp
should show. One that claims simulated time from a node on wall time is never found in the TF buffer.

Example that is reported:

```yaml
interfaces:
  /preview: {topic: sensor_msgs/msg/Image, from: perception, to: {task: {depth: 1}}, frame: camera/color_optical,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal,
             time_source: hardware}  # expect at time_source
```

Example that is accepted:

```yaml
interfaces:
  /preview: {topic: sensor_msgs/msg/Image, from: perception, to: {task: {depth: 1}}, frame: camera/color_optical,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal, time_source: ros}
```

Fix: write the clock with which the publisher really stamps.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.interface import Interface
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_OTHER = {"wall": "sim", "sim": "wall"}


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield interfaces whose time source is not that of a node or device that publishes them."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.time_source is None:
            continue
        for node, clock in _clocks(graph, interface):
            hardware = interface.time_source == "hardware" and clock != "hardware"
            if hardware or clock == _OTHER.get(interface.time_source):
                message = (
                    f"`{interface.name}` claims {interface.time_source} stamps, but `{node}` stamps with {clock} time"
                )
                yield found(graph, (*interface.path, "time_source"), message)
                break


def _clocks(graph: CellGraph, interface: Interface) -> Iterator[tuple[str, str]]:
    """Yield each publisher with its clock: what a sensor states, what a node runs on, or that of all targets."""
    clocks = graph.once(_node_clocks)
    targets = {target.clock for target in graph.cell.targets.values()}
    common = targets.pop() if len(targets) == 1 else "ros"
    for source in interface.sources:
        stamp = graph.cell.stamp_of(source.node)
        yield source.node, clocks.get(source.node) or common if stamp is None else stamp.source


def _node_clocks(graph: CellGraph) -> Mapping[str, str | None]:
    return {node.name: node.clock for node in graph.cell.nodes}
