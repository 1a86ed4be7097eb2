"""The version tuple of a cell: what exactly stands there, UNKNOWN where nobody has said."""

from __future__ import annotations

from cellc.cell.cell import Cell

_OF_CELL = ("os", "kernel", "ros", "rmw", "ros2_control", "moveit")
_OF_DEVICE = ("revision", "serial", "firmware", "driver", "sdk", "description")


def version_tuple(cell: Cell) -> dict[str, str]:
    """Return every part by name: ``kernel``, ``rollback.image``, ``arm.firmware``."""
    versions = cell.spec.versions
    parts = {name: str(getattr(versions, name)) for name in _OF_CELL}
    parts |= {
        "rollback.image": versions.rollback.image,
        "rollback.configuration": versions.rollback.configuration,
    }
    for device in cell.devices:
        parts |= {f"{device.name}.{name}": str(getattr(device.spec, name)) for name in _OF_DEVICE}
    return parts
