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

from cellc.diagnostics import Related, Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def _seconds(value: float | None) -> str:
    return "none" if value is None else f"{value:g} s"


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    for pair in graph.data.topic_pairs():
        offered, requested = pair.source.qos, pair.sink.qos
        if requested.lease_duration_s is not None and (
            offered.lease_duration_s is None or offered.lease_duration_s > requested.lease_duration_s
        ):
            message = (
                f"`{pair.sink.node}` wants a lease of {requested.lease_duration_s:g} s on `{pair.topic.name}`, "
                f"`{pair.source.node}` promises {_seconds(offered.lease_duration_s)}"
            )
            related = (Related("offered here", pair.source.span),)
            yield found(graph, pair.sink.path, message, "promise a lease that is at least as short", related)


RULE = define("lease-mismatch", Severity.ERROR, check, __doc__)
