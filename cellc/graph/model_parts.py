"""Links and joints of every device's description, each with the place where the user can change it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.description.model import Joint, Link
from cellc.diagnostics import Span, YamlPath


@dataclass(frozen=True, slots=True)
class ModelLink:
    """A link; ``span`` is its element in the description, or the device's model where that has no place."""

    device: Device
    link: Link
    span: Span
    path: YamlPath


@dataclass(frozen=True, slots=True)
class ModelJoint:
    """A joint; ``span`` is its element in the description, or the device's model where that has no place."""

    device: Device
    joint: Joint
    span: Span
    path: YamlPath


@dataclass(frozen=True, slots=True)
class ModelParts:
    """The robot descriptions of a cell, part by part, in the order of the files."""

    cell: Cell

    def links(self) -> Iterator[ModelLink]:
        """Yield every link of every device."""
        for device in self.cell.devices:
            path = (*device.path, "model")
            for link in device.description.links:
                yield ModelLink(device, link, link.span or self.cell.locate(*path), path)

    def joints(self) -> Iterator[ModelJoint]:
        """Yield every joint of every device."""
        for device in self.cell.devices:
            path = (*device.path, "model")
            for joint in device.description.joints:
                yield ModelJoint(device, joint, joint.span or self.cell.locate(*path), path)
