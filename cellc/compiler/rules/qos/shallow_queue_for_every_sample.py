"""A reader that wants every sample keeps only one.

Two samples that arrive between two calls of the reader overwrite each other, reliable or not.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {reliability: reliable, depth: 10}}
    to: {task: {reliability: reliable, depth: 1}}  # expect at task
    frame: world
    wants: every_sample
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Example that is accepted:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {reliability: reliable, depth: 10}}
    to: {task: {reliability: reliable, depth: 10}}
    frame: world
    wants: every_sample
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: raise `depth` to what arrives during the longest pause of the reader, or use `history: keep_all`.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield subscribers of depth one on a topic of which every sample counts."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "every_sample":
            continue
        for end in topic.sinks:
            if end.qos.history == "keep_last" and end.qos.depth == 1:
                message = f"every sample of `{topic.name}` counts, but `{end.node}` keeps one"
                yield found(graph, end.path, message)
