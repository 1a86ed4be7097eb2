"""A late joiner demands history that its publisher does not keep.

The middleware does not connect the two. The topic shows in every list, and no sample ever arrives.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {durability: volatile, depth: 1}}
    to: {task: {durability: transient_local, depth: 1}}  # expect at task
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

from cellc.rules.kit import CellGraph, Findings, Severity, rule
from cellc.rules.qos_offers import weak_offers


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "durability")
