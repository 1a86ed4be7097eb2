"""A subscriber demands a shorter deadline than its publisher promises.

The middleware does not connect the two. A publisher that promises nothing offers an infinite deadline.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, deadline: 300 ms}}
    to: {task: {depth: 1, deadline: 150 ms}}
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
    from: {perception: {depth: 1, deadline: 150 ms}}
    to: {task: {depth: 1, deadline: 150 ms}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: promise a deadline that is at least as short

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
    return "nothing" if value is None else f"{value:g} s"


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    for pair in graph.data.topic_pairs():
        offered, requested = pair.source.qos, pair.sink.qos
        if requested.deadline_s is not None and (
            offered.deadline_s is None or offered.deadline_s > requested.deadline_s
        ):
            message = (
                f"`{pair.sink.node}` wants a sample of `{pair.topic.name}` every {requested.deadline_s:g} s, "
                f"`{pair.source.node}` promises {_seconds(offered.deadline_s)}"
            )
            related = (Related("offered here", pair.source.span),)
            yield found(graph, pair.sink.path, message, "promise a deadline that is at least as short", related)


RULE = define("deadline-mismatch", Severity.ERROR, check, __doc__)
