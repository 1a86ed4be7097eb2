"""Nothing shows that a node is ready.

A started process proves nothing. A managed node has a state; others show an interface, a transform or the goals that
they send. A node with none of them counts as ready because it was spawned.

Example that is reported:

```yaml
nodes:
  warmer: {run: cell_tasks/warmer, host: control_pc, owner: integration}  # expect at warmer
```

Example that is accepted:

```yaml
nodes:
  warmer: {run: cell_tasks/warmer, host: control_pc, owner: integration, lifecycle: true}
```

Fix: add `lifecycle: true`, or declare what the node publishes or serves, or the frame by which it can be seen.

Source: docs/principles.md#start-up
"""

from __future__ import annotations

from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LISTENERS = frozenset(
    ("foxglove_bridge", "plotjuggler", "rosbag2_transport", "rosbridge_server", "rqt_gui", "rviz2", "web_video_server")
)
"""Packages whose programs only show or record: nothing of the cell waits for them."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield nodes of the spec without a lifecycle, an interface, a frame or a controller that they command."""
    shown = {end.node for interface in graph.cell.interfaces for end in (*interface.sources, *interface.sinks)}
    shown |= {frame.authority for frame in graph.cell.frames}
    shown |= {controller.client for controller in graph.cell.controllers if controller.client}
    for node in graph.cell.nodes:
        if node.package in _LISTENERS:
            continue
        if node.source is NodeSource.SPEC and not node.lifecycle and node.name not in shown:
            message = f"no state, interface or transform shows that `{node.name}` is ready"
            yield found(graph, node.path, message)
