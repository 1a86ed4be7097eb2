"""A topic does not say whether every sample counts or only the newest.

Queue, reliability and age follow from that answer. Left open, the default queue of ten serves neither: it drops
samples for one and delays them for the other.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}},  # expect at /markers
             frame: world,
             rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: add `wants: newest` for state and images, `wants: every_sample` for events.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield topics of the spec with a reader and without a stated need."""
    for interface in graph.cell.interfaces:
        if (
            interface.kind is InterfaceKind.TOPIC
            and not interface.derived
            and interface.sinks
            and interface.wants is None
        ):
            message = f"`{interface.name}` does not say whether every sample counts or only the newest"
            yield found(graph, interface.path, message)
