"""The topics that the catalogue says a device publishes, under their names in this cell."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.cell.cell import Cell
from cellc.cell.device import Device


def device_topics(cell: Cell, device: Device) -> Mapping[str, str]:
    """Return full topic name → message type."""
    return device.topics
