"""A subscriber requests liveliness that its publisher does not assert.

The middleware does not connect the two.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, liveliness: automatic}}
    to: {task: {depth: 1, liveliness: manual_by_topic}}  # expect at task
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

Fix: request `automatic`, or let the publisher assert its liveliness with `manual_by_topic`.

Source: https://github.com/ros2/rmw_dds_common/blob/5a2951c89fa620ec1a37378c4f7178d9c4aadd63/rmw_dds_common/src/qos.cpp
(5a2951c): the offer must be at least as strong as the request
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule
from cellc.compiler.rules.qos_offers import weak_offers


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "liveliness")
