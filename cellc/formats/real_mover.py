"""What moves a device on the real target, in words: a component of ros2_control, or the driver's own node."""

from __future__ import annotations

from cellc.cell.device import Device

_NOTHING = "nothing that the catalogue names"


def real_mover(device: Device) -> str:
    """Return the plugin that moves a device on the real target, or the node with its program."""
    plugin = None if device.hardware is None else device.hardware.plugins.get("real")
    if plugin is not None:
        return plugin
    return _NOTHING if device.driver is None else f"{device.driver.node} ({device.driver.program})"
