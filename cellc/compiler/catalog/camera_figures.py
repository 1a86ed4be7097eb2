"""Streams of a camera in a device.yaml against each other: sizes and shapes of images, topics, frames and times."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.catalog.device_graph import StreamFacts
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.contract.diagnostics import YamlPath

BYTES = {
    **dict.fromkeys(("mono8", "8UC1", "bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"), 1),
    **dict.fromkeys(("mono16", "16UC1", "16SC1", "yuv422", "yuv422_yuy2", "uyvy", "yuyv"), 2),
    **dict.fromkeys(("rgb8", "bgr8", "8UC3"), 3),
    **dict.fromkeys(("rgba8", "bgra8", "8UC4", "32FC1"), 4),
}
"""Encoding → bytes of a pixel: sensor_msgs/include/sensor_msgs/image_encodings.hpp of common_interfaces 5.3.6."""
_IMAGE = "sensor_msgs/msg/Image"
_SHAPE = 1.6
"""By which the shape of an image may differ from that of its field of view: a profile of 4:3 crops one of 16:9."""


Contradiction = tuple[YamlPath, str, YamlPath]
"""Where a figure is, what is wrong of it, and where the other one is; the same place where nothing else is."""


def camera_faults(model: DeviceModel) -> Iterator[Contradiction]:
    """Yield what the streams of a camera contradict."""
    camera = model.camera
    if camera is None:
        return
    optical = {model.frames.get(name, name) for name in model.optical_frames}
    topics: dict[str, str] = {}
    for name, stream in camera.streams.items():
        path: YamlPath = ("camera", "streams", name)
        for place, message, other in (*_of_image(stream), *_of_view(stream)):
            yield (*path, *place), message, (*path, *other)
        if optical and stream.frame not in optical:
            message = f"`frame` of `{name}` must be one of `optical_frames`, got `{stream.frame}`"
            yield (*path, "frame"), message, ("optical_frames",)
        for key in ("topic", "info_topic"):
            topic = getattr(stream, key)
            first = topics.setdefault(topic, name)
            if first != name:
                message = f"`{key}` of `{name}` must be a topic of its own, got that of `{first}`"
                yield (*path, key), message, ("camera", "streams", first, key)
        if camera.exposure is not None and camera.exposure.si >= 1.0 / stream.rate.si:
            message = f"`exposure` must be below the period of `{name}`, {1e3 / stream.rate.si:.3g} ms,"
            yield ("camera", "exposure"), f"{message} got {camera.exposure.text}", (*path, "rate")


def _of_image(stream: StreamFacts) -> Iterator[Contradiction]:
    image = stream.image
    if image is None:
        return
    size = BYTES.get(image.encoding or "")
    if size is not None and stream.type == _IMAGE and image.bytes_per_pixel != size:
        message = f"`bytes_per_pixel` must be {size}, as `{image.encoding}` has, got {image.bytes_per_pixel}"
        yield ("image", "bytes_per_pixel"), message, ("image", "encoding")
    if not stream.type.endswith("Image"):
        yield ("type",), f"`type` must be that of an image, got `{stream.type}`", ("image",)


def _of_view(stream: StreamFacts) -> Iterator[Contradiction]:
    """Yield a field of view of another shape than the images have: turned, or one of its angles in another unit."""
    view, image = stream.view, stream.image
    if view is None or image is None or max(view.horizontal.si, view.vertical.si) > 2.5:
        return
    seen = math.tan(view.horizontal.si / 2.0) / math.tan(view.vertical.si / 2.0)
    shape = image.width / image.height
    if not shape / _SHAPE <= seen <= shape * _SHAPE:
        message = f"`horizontal` and `vertical` must have the shape of the images, {image.width} by {image.height},"
        got = f"got {view.horizontal.text} and {view.vertical.text}"
        yield ("view", "horizontal"), f"{message} {got}", ("image", "width")
