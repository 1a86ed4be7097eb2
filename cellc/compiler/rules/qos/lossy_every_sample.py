"""A reader that wants every sample accepts losses.

Best effort drops lost samples without notice.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {reliability: best_effort}}
    to: {task: {reliability: best_effort}}  # expect at task
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
    from: {perception: {reliability: reliable}}
    to: {task: {reliability: reliable}}
    frame: world
    wants: every_sample
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: use `reliability: reliable` on both sides, with a depth that covers the longest pause of the reader.

Source: docs/principles.md#delivery-contracts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield best-effort endpoints on a topic of which every sample counts."""
    for topic in graph.cell.interfaces:
        if topic.derived or topic.wants != "every_sample":
            continue
        lossy = next((end for end in (*topic.sinks, *topic.sources) if end.qos.reliability == "best_effort"), None)
        if lossy is not None:
            message = f"every sample of `{topic.name}` counts, but `{lossy.node}` uses best effort"
            yield found(graph, lossy.path, message)
