"""Where a mock begins: the position of every joint before the first command."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.device import Device, DeviceJoint

HOME = "home"
"""A named pose of this name is where the cell begins."""


def start_positions(cell: Cell) -> dict[str, float]:
    """Return a position for each joint that moves on its own, rad or m.

    The pose ``home`` of the cell counts first, then the home of the catalogue, then zero. A value outside the limits is
    moved to the nearest limit: a trajectory controller whose joint begins outside them fails in its first update.
    """
    of_cell = {
        joint: position
        for pose in cell.poses
        if pose.name == HOME
        for joint, position in zip(pose.joints, pose.positions, strict=False)
    }
    return {
        joint.name: _within(joint, of_cell.get(joint.name, catalogue))
        for device in cell.devices
        for joint, catalogue in _catalogue_home(device)
    }


def _catalogue_home(device: Device) -> Iterator[tuple[DeviceJoint, float]]:
    home = device.facts.home or {}
    for joint in device.joints:
        if joint.mimics is None:
            written = home.get(joint.local_name)
            yield joint, 0.0 if written is None else written.si


def _within(joint: DeviceJoint, position: float) -> float:
    if joint.type == "continuous":
        return position
    lower = -math.inf if joint.lower is None else joint.lower
    upper = math.inf if joint.upper is None else joint.upper
    return min(max(position, lower), upper)
