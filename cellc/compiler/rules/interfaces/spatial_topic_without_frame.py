"""A topic with positions names no frame.

Poses, points and clouds are in some frame. If the spec does not say which, it cannot be checked that the reader
transforms from the right one.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}},  # expect at /markers
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: add `frame:`, for camera data the optical frame.

Source:

- docs/principles.md#command-contracts
- https://www.ros.org/reps/rep-0103.html (as of 2025-10-24)
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.graph.data_flow import interface_types
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics of the spec that carry positions and can move something, without a frame."""
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived or interface.frame is not None:
            continue
        facts = interface_types().get(interface.type)
        if facts is None or not (facts.unit or "").startswith("m"):
            continue
        if facts.feeds_motion or interface.name in graph.data.feeding_motion():
            message = f"`{interface.name}` carries `{interface.type}` but names no frame"
            yield found(graph, interface.path, message)
