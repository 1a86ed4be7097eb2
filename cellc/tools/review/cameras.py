"""What cameras see, as facts that two models have alike: topics of images may have other names."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping

from cellc.contract.devices import ContractCamera, ContractDevice, ContractImages
from cellc.tools.review.leaves import Leaf, Path


def of_cameras(devices: Mapping[str, ContractDevice]) -> Iterator[tuple[Path, Leaf]]:
    """Yield range, field of view and resolution of each camera, by what its images hold."""
    for name, device in devices.items():
        if device.camera is not None:
            yield from _of_camera(name, device.camera)


def without_images(devices: Mapping[str, ContractDevice]) -> dict[str, ContractDevice]:
    """Return devices without what the facts above say."""
    return {name: _without_images(device) for name, device in devices.items()}


def _of_camera(device: str, camera: ContractCamera) -> Iterator[tuple[Path, Leaf]]:
    """Yield what a camera sees, by what its images hold: of two models the topics may have other names."""
    kinds = Counter(_kind_of(images) for images in camera.images)
    for images in camera.images:
        kind = _kind_of(images)
        kind = kind if kinds[kind] == 1 else f"{kind} {images.topic}"
        across, down = math.degrees(images.horizontal), math.degrees(images.vertical)
        yield ("camera", device, "range", kind), f"{images.nearest_m:g} to {images.farthest_m:g} m"
        yield ("camera", device, "view", kind), f"{across:.4g} x {down:.4g} deg"
        yield ("camera", device, "resolution", kind), f"{images.width} x {images.height}"
        for what in ("topic", "info_topic", "frame", "encoding"):
            yield ("camera", device, "images", kind, what), getattr(images, what)


def _kind_of(images: ContractImages) -> str:
    return "depth" if images.encoding in ("16UC1", "32FC1") else "color"


def _without_images(device: ContractDevice) -> ContractDevice:
    camera = device.camera
    rest = None if camera is None else camera.model_copy(update={"images": ()})
    return device.model_copy(update={"camera": rest})
