"""The topics that the catalogue says a device publishes, under their names in this cell."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.link.placeholders import placeholders

_CAMERA_INFO = "sensor_msgs/msg/CameraInfo"


def device_topics(cell: Cell, device: Device) -> Mapping[str, str]:
    """Return full topic name → message type."""
    streams = () if device.facts.camera is None else tuple(device.facts.camera.streams.values())
    types = {topic.name: topic.type for topic in device.facts.topics}
    types |= {stream.topic: stream.type for stream in streams}
    types |= {stream.info_topic: _CAMERA_INFO for stream in streams}
    known = placeholders(device.name, device.prefix, device.spec, cell.spec)
    return {known.fill(name): type_ for name, type_ in types.items()}
