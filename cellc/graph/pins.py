"""The version tuple as a list of pins, each with the place where it is written."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.diagnostics import YamlPath
from cellc.graph.responsibilities import UNKNOWN

_NUMBER = re.compile(r"\d+(?:\.\d+)*")
_DEVICE_PARTS = ("revision", "firmware", "driver", "sdk", "description")


@dataclass(frozen=True, slots=True)
class Pin:
    """One part of the tuple: ``holder`` is the cell or a device, ``text`` as written."""

    holder: str
    part: str
    text: str
    path: YamlPath

    @property
    def known(self) -> bool:
        """Whether something else than UNKNOWN is written."""
        return self.text != UNKNOWN


def cell_pins(cell: Cell) -> Iterator[Pin]:
    """Yield the parts of the tuple that belong to the whole cell; MoveIt is no part of a cell that has no goals."""
    versions = cell.versions
    texts = {
        "os": versions.os,
        "kernel": versions.kernel,
        "ros": versions.ros,
        "rmw": versions.rmw,
        "ros2_control": versions.ros2_control,
        "moveit": versions.moveit,
    }
    for part, text in texts.items():
        if part != "moveit" or cell.goals or text != UNKNOWN:
            yield Pin(cell.name, part, text, ("versions", part))


def device_pins(cell: Cell) -> Iterator[Pin]:
    """Yield the parts of the tuple of each device; what its catalogue entry says it has none of is left out."""
    for device in cell.devices:
        packages = device.packages
        absent = {"driver": packages.driver, "sdk": packages.sdk, "description": packages.description}
        for part in _DEVICE_PARTS:
            text = device.versions.part(part)
            if text != UNKNOWN or absent.get(part, part) is not None:
                yield Pin(device.name, part, text, (*device.path, part))


def version_number(text: str) -> str:
    """Return the version in a pin such as ``driver_package 3.8.0``; empty where there is none."""
    last = text.split()[-1] if text.split() else ""
    match = _NUMBER.search(last)
    return match.group() if match else ""


def version_numbers(text: str) -> tuple[int, ...]:
    """Return a version as numbers that compare."""
    return tuple(int(part) for part in version_number(text).split(".") if part)
