"""The pinned middleware ignores a QoS policy.

With Zenoh, deadline, liveliness and incompatible QoS raise no event: a watchdog that rests on one of them never
fires.

Example that is reported:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1, deadline: 150 ms}}  # expect at deadline
    to: {task: {depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
versions: {rmw: rmw_zenoh_cpp 0.2.10}
network: {discovery: multicast}
```

Example that is accepted:

```yaml
interfaces:
  /markers:
    topic: geometry_msgs/msg/PoseStamped
    from: {perception: {depth: 1}}
    to: {task: {depth: 1}}
    frame: world
    wants: newest
    rate: 10 Hz
    max_age: 200 ms
    on_stale: reject_goal
versions: {rmw: rmw_zenoh_cpp 0.2.10}
network: {discovery: multicast}
```

Fix: watch `max_age` in the reader instead, or choose a DDS middleware.

Source: https://github.com/ros2/rmw_zenoh/blob/99a6a2bd10b949052f4f12c5854825dc005e95a5/docs/design.md
(99a6a2b): events that are not produced
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield endpoints that set a policy which Zenoh does not watch."""
    if not graph.cell.versions.rmw.startswith("rmw_zenoh"):
        return
    for topic in graph.cell.interfaces:
        for end in (*topic.sources, *topic.sinks):
            watched = (("deadline", end.qos.deadline_s), ("lease_duration", end.qos.lease_duration_s))
            field = next((field for field, value in watched if value is not None), None)
            if field is not None and not topic.derived:
                message = f"`{end.node}` sets `{field}` on `{topic.name}`, which Zenoh does not watch"
                yield found(graph, (*end.path, field), message)
