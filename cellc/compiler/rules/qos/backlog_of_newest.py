"""A reader that wants the newest sample queues old ones.

When the reader is late, a queue hands it the oldest sample that it keeps first. It then works through a backlog of
images in which the part is still where it was. What makes the backlog is the depth. A best-effort queue is left alone,
because lost samples are not sent again and five is what sensors are usually read with (REP 2003); where it holds what
is too old to be used, `queue-older-than-max-age` tells.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1}}
    to: {task: {reliability: reliable, depth: 10}}  # expect at task
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
    from: {perception: {depth: 1}}
    to: {task: {reliability: reliable, depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: use `depth: 1`; for high-rate sensor data also `reliability: best_effort`.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield subscribers whose queue keeps what is old of a topic of which they want the newest sample."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "newest":
            continue
        for end in topic.sinks:
            endless = end.qos.history == "keep_all"
            queue = "every sample" if endless else f"{end.qos.depth} samples"
            message = f"`{end.node}` wants the newest of `{topic.name}` but queues {queue}"
            if end.qos.reliability == "reliable":
                if endless or end.qos.depth > 1:
                    yield found(graph, end.path, f"{message} reliably")
            elif endless and topic.rate_hz and topic.max_age_s is not None:
                yield found(graph, end.path, message)
