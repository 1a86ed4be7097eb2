"""A subscriber demands that a publisher asserts its life, which it does not.

The middleware does not connect the two.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, liveliness: automatic}}
    to: {task: {depth: 1, liveliness: manual_by_topic}}
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
    from: {perception: {depth: 1, liveliness: manual_by_topic}}
    to: {task: {depth: 1, liveliness: manual_by_topic}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: ask for automatic, or let the publisher assert by topic

Source: rmw_dds_common, qos_profile_check_compatible: the offer has to be at least as strong as the request.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Related, Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    for pair in graph.data.topic_pairs():
        offered, requested = pair.source.qos, pair.sink.qos
        if (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"):
            message = (
                f"`{pair.sink.node}` wants `{pair.source.node}` to assert its life on `{pair.topic.name}` "
                f"by topic, it offers automatic"
            )
            related = (Related("offered here", pair.source.span),)
            yield found(
                graph, pair.sink.path, message, "ask for automatic, or let the publisher assert by topic", related
            )


RULE = define("liveliness-mismatch", Severity.ERROR, check, __doc__)
