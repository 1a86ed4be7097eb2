"""A reader that wants the newest sample queues old ones.

When the reader is late, a queue hands it the oldest sample that it keeps first. It then works through a backlog of
images in which the part is still where it was. What makes the backlog is the depth: a best-effort queue hands out old
samples too, and is reported where the oldest that it can keep is older than the reader may use. A shorter one is left
alone, because lost samples are not sent again and five is what sensors are usually read with (REP 2003).

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

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


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
            elif topic.rate_hz and topic.max_age_s is not None:
                oldest_s = (end.qos.depth - 1) / topic.rate_hz
                if endless:
                    yield found(graph, end.path, message)
                elif oldest_s > topic.max_age_s:
                    older = f"the oldest {oldest_s * 1e3:.4g} ms behind the newest"
                    yield found(graph, end.path, f"{message}, {older}, and may use {topic.max_age_s * 1e3:.4g} ms")
