"""A subscriber demands reliable samples of a best-effort publisher.

The middleware does not connect the two. The topic shows in every list, and no sample ever arrives.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {reliability: best_effort, depth: 1}}
    to: {task: {reliability: reliable, depth: 1}}
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
    from: {perception: {reliability: reliable, depth: 1}}
    to: {task: {reliability: reliable, depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
```

Fix: ask for best effort, or publish reliably

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
    return (offered.reliability, requested.reliability) == ("best_effort", "reliable")


def _message(pair: TopicPair) -> str:
    return f"`{pair.sink.node}` wants `{pair.topic.name}` reliable, `{pair.source.node}` offers best effort"


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield subscribers that ask for more than their publisher offers."""
    return unmatched(graph, _refused, _message, "ask for best effort, or publish reliably")


RULE = define("reliability-mismatch", Severity.ERROR, check, __doc__)
