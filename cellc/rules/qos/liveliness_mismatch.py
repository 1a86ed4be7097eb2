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

from cellc.cell.interface import Qos
from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.graph.data_flow import TopicPair
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.unmatched import unmatched


def _refused(offered: Qos, requested: Qos) -> bool:
    return (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic")


def _message(pair: TopicPair) -> str:
    return (
        f"`{pair.sink.node}` wants `{pair.source.node}` to assert its life on `{pair.topic.name}` "
        f"by topic, it offers automatic"
    )


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    return unmatched(graph, _refused, _message, "ask for automatic, or let the publisher assert by topic")


RULE = define("liveliness-mismatch", Severity.ERROR, check, __doc__)
