"""A deadline is shorter than the publishing period.

Every period misses it, so the event that should tell of a dead publisher fires all the time and is ignored.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, deadline: 50 ms}}  # expect at deadline
    to: {task: {depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Example that is accepted:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, deadline: 150 ms}}
    to: {task: {depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: make the deadline longer than one period, with room for jitter.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield endpoints with a deadline that a publisher on time cannot keep."""
    for topic in graph.cell.interfaces:
        if topic.kind is not InterfaceKind.TOPIC or not topic.rate_hz:
            continue
        for end in (*topic.sources, *topic.sinks):
            if end.qos.deadline_s is not None and end.qos.deadline_s < 1.0 / topic.rate_hz:
                deadline, period = end.qos.deadline_s * 1e3, 1e3 / topic.rate_hz
                message = (
                    f"`deadline` of `{end.node}` on `{topic.name}` must be at least its period of {period:.4g} ms, "
                    f"got {deadline:g} ms"
                )
                path = (*end.path, "deadline")
                yield found(graph, path, message, f"allow at least {period:.4g} ms")
