"""A recorded topic has no publisher.

The bag has no such channel, and it is noticed when it is needed.

Example that is reported:

```yaml
recording: {topics: [/object_posee, /camera/camera/color/image_raw]}  # expect at topics.0
```

Example that is accepted:

```yaml
recording: {topics: [/object_pose, /camera/camera/color/image_raw]}
```

Fix: name a topic of the cell.

Source: docs/principles.md#records-of-attempts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule

_ALWAYS = ("/diagnostics", "/rosout", "/parameter_events", "/tf", "/tf_static", "/clock", "/joint_states")


@rule(Severity.WARNING, assumes=("illegal-ros-name",))
def check(graph: CellGraph) -> Findings:
    """Yield recorded topics that no interface declares and no device publishes."""
    known = {*_ALWAYS, *(interface.name for interface in graph.cell.interfaces)}
    for device in graph.cell.devices:
        known |= set(device.topics)
    for index, topic in enumerate(graph.cell.recording.topics):
        if topic not in known:
            path = ("recording", "topics", index)
            yield found(graph, path, f"`{topic}` has no publisher", did_you_mean(topic, known, "topics"))
