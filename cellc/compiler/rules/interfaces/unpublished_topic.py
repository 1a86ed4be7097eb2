"""A topic has no publisher.

Its subscribers wait forever, or go on with what they had.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: [], to: {task: {depth: 1}}, frame: world,  # expect at from
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: name the publisher.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics without a publisher."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC and not interface.sources:
            yield found(graph, (*interface.path, "from"), f"`{interface.name}` has no publisher")
