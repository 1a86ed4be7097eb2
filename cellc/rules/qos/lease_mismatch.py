"""A subscriber demands a shorter lease than its publisher promises.

The middleware does not connect the two. A publisher that promises nothing offers an infinite lease.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, lease_duration: 2 s}}
    to: {task: {depth: 1, lease_duration: 1 s}}
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
    from: {perception: {depth: 1, lease_duration: 1 s}}
    to: {task: {depth: 1, lease_duration: 1 s}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: promise a lease that is at least as short

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
from cellc.rules.unmatched import longer, unmatched


def _refused(offered: Qos, requested: Qos) -> bool:
    return longer(offered.lease_duration_s, requested.lease_duration_s)


def _message(pair: TopicPair) -> str:
    offered_s, requested_s = pair.source.qos.lease_duration_s, pair.sink.qos.lease_duration_s
    promised = "none" if offered_s is None else f"{offered_s:g} s"
    return (
        f"`{pair.sink.node}` wants a lease of {requested_s:g} s on `{pair.topic.name}`, "
        f"`{pair.source.node}` promises {promised}"
    )


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    return unmatched(graph, _refused, _message, "promise a lease that is at least as short")


RULE = define("lease-mismatch", Severity.ERROR, check, __doc__)
