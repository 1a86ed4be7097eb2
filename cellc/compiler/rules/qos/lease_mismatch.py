"""A subscriber requests a shorter lease than its publisher promises.

The middleware does not connect the two. A publisher that promises nothing offers an infinite lease.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, lease_duration: 2 s}}
    to: {task: {depth: 1, lease_duration: 1 s}}  # expect at task
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

Fix: promise a lease that is at least as short.

Source: https://github.com/ros2/rmw_dds_common/blob/5a2951c89fa620ec1a37378c4f7178d9c4aadd63/rmw_dds_common/src/qos.cpp
(5a2951c): the offer must be at least as strong as the request
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule
from cellc.compiler.rules.qos_offers import weak_offers


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "lease_duration")
