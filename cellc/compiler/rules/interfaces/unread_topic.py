"""A topic has no subscriber.

Either a reader was forgotten, or bandwidth and attention go to unused data.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: [], frame: world,  # expect at /markers
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: name its readers under `to:`, or delete the topic; what is only recorded belongs under `recording.topics`.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield topics of the spec without a subscriber that are not recorded either."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.kind is not InterfaceKind.TOPIC or interface.sinks:
            continue
        if interface.name not in graph.cell.recording.topics:
            yield found(graph, interface.path, f"`{interface.name}` has no subscriber")
