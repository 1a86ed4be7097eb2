"""What a decision rests on is not in the recording.

A failed grasp is judged by what the camera saw. Where the spec lists the topics that are recorded beyond the
motion path and leaves out the images or clouds, a bad detection cannot be distinguished from a bad calibration.

Example that is reported:

```yaml
recording: {topics: [/object_pose]}  # expect at topics
```

Example that is accepted:

```yaml
recording: {topics: [/object_pose, /camera/camera/color/image_raw]}
```

Fix: add the images, at best as a compressed topic.

Source: docs/principles.md#records-of-attempts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_BULK = ("/Image", "/PointCloud2", "/CompressedImage")
"""What is not recorded unless it is asked for."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield images and clouds that feed motion and are not among the recorded topics, where the spec lists some."""
    if not graph.cell.recording.topics:
        return
    feeding = graph.data.feeding_motion()
    for interface in graph.cell.interfaces:
        if not interface.type.endswith(_BULK) or interface.derived or interface.name not in feeding:
            continue
        stem = interface.name.rpartition("/")[0]
        if not any(topic == interface.name or topic.startswith(f"{stem}/") for topic in graph.cell.recording.topics):
            message = f"`{interface.name}` feeds motion and must be recorded"
            related = (Related("decisions rest on it", interface.span),)
            yield found(graph, ("recording", "topics"), message, related=related)
