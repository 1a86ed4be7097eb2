"""Samples expire before they are too old.

The middleware drops what the reader would still use, silently: the reader sees a gap and not a stale sample.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, lifespan: 100 ms}}  # expect at lifespan
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
    from: {perception: {depth: 1, lifespan: 500 ms}}
    to: {task: {depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: make `lifespan` at least as long as `max_age`, or leave it out.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield publishers whose samples expire before the age limit of the topic."""
    for topic in graph.cell.interfaces:
        for end in topic.sources:
            if topic.max_age_s is not None and end.qos.lifespan_s is not None and end.qos.lifespan_s < topic.max_age_s:
                message = (
                    f"`lifespan` of `{topic.name}` must be at least its `max_age` of {topic.max_age_s * 1e3:g} ms, "
                    f"got {end.qos.lifespan_s * 1e3:g} ms"
                )
                yield found(graph, (*end.path, "lifespan"), message)
