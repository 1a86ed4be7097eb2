"""A late joiner demands history that its publisher does not keep.

The middleware does not connect the two. The topic shows in every list, and no sample ever arrives.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {durability: volatile, depth: 1}}
    to: {task: {durability: transient_local, depth: 1}}
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
    from: {perception: {durability: transient_local, depth: 1}}
    to: {task: {durability: transient_local, depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: ask for volatile, or publish transient local

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
    return (offered.durability, requested.durability) == ("volatile", "transient_local")


def _message(pair: TopicPair) -> str:
    return f"`{pair.sink.node}` wants the history of `{pair.topic.name}`, `{pair.source.node}` keeps none"


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    return unmatched(graph, _refused, _message, "ask for volatile, or publish transient local")


RULE = define("durability-mismatch", Severity.ERROR, check, __doc__)
