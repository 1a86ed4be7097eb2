"""What keeps the real target closed: joints that controllers command and that no hardware moves there."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, DeviceJoint


def unmoved_on_real(cell: Cell) -> Iterator[tuple[Device, DeviceJoint]]:
    """Yield devices with joints that a controller names, and neither a plugin nor a driver on the real target.

    Each is yielded with the first of these joints.
    """
    named = {joint for manager in cell.managers for controller in manager.controllers for joint in controller.joints}
    for device in cell.devices:
        hardware = device.control.hardware
        if hardware is None or "real" in hardware.targets or device.control.driver is not None:
            continue
        joint = next((joint for joint in device.joints if joint.name in named), None)
        if joint is not None:
            yield device, joint
