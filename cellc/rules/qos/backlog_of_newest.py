"""A reader that wants the newest sample queues old ones reliably.

When the reader is late, a queue hands it the oldest sample that it keeps first. It then works through a backlog of
images in which the part is still where it was. What makes the backlog is the depth: a best-effort queue of five hands
out five old samples too. It is left alone because lost samples are not sent again and five is what sensors are usually
read with (REP 2003); only a depth of 1 has no backlog at all.

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
    """Yield subscribers with a deep reliable queue on a topic of which they want the newest sample."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "newest":
            continue
        for end in topic.sinks:
            deep = end.qos.history == "keep_all" or end.qos.depth > 1
            if deep and end.qos.reliability == "reliable":
                queue = "every sample" if end.qos.history == "keep_all" else f"{end.qos.depth} samples"
                message = f"`{end.node}` wants the newest of `{topic.name}` but queues {queue} reliably"
                yield found(graph, end.path, message)
