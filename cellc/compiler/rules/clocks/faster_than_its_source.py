"""Poses are promised faster than the images they are seen in arrive.

A detector that publishes twice for each image repeats an old observation, and the age that its readers judge is that of
the image. The promised rate is met by copies, or not at all.

Example that is reported:

```yaml
interfaces:
  /camera/camera/color/image_raw: {rate: 5 Hz, max_age: 300 ms}
  /object_pose: {rate: 10 Hz, max_age: 400 ms}  # expect at rate
```

Example that is accepted:

```yaml
interfaces:
  /camera/camera/color/image_raw: {rate: 15 Hz}
```

Fix: let the camera run faster, or promise the rate of its images.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.cell.interface import Interface, InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_ROUNDING = 1.001


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield topics of a node in a frame of a camera that are faster than all that it hears from this camera."""
    frames = {device.name: set(device.frames.values()) for device in graph.cell.devices if device.camera is not None}
    topics = [
        interface for interface in graph.cell.interfaces if interface.kind is InterfaceKind.TOPIC and interface.rate_hz
    ]
    heard_by: dict[str, list[Interface]] = {}
    for topic in topics:
        for node in dict.fromkeys(sink.node for sink in topic.sinks):
            heard_by.setdefault(node, []).append(topic)
    for topic in topics:
        for source in topic.sources:
            heard = [interface for interface in heard_by.get(source.node, ()) if _seen_by(interface, topic, frames)]
            fastest = max(heard, key=lambda one: one.rate_hz or 0.0, default=None)
            if fastest is not None and (topic.rate_hz or 0.0) > (fastest.rate_hz or 0.0) * _ROUNDING:
                message = f"`{topic.name}` must be at most as fast as `{fastest.name}`, {fastest.rate_hz:g} Hz,"
                related = (Related("what it is seen in", graph.cell.locate(*fastest.path, "rate")),)
                yield found(graph, (*topic.path, "rate"), f"{message} got {topic.rate_hz:g} Hz", related=related)


def _seen_by(image: Interface, topic: Interface, frames: dict[str, set[str]]) -> bool:
    return any(topic.frame in frames.get(source.node, ()) for source in image.sources)
