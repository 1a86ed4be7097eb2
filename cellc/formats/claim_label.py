"""What the arrows into vendor control and from physical safety say."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.device import Device, DeviceDriver
from cellc.formats.numbers import shortest
from cellc.formats.real_mover import real_mover

_NOT_STATED = "not stated"
# REP-103: SI and radians; by the joint's type.
_UNITS = {
    "position": ("rad", "m"),
    "velocity": ("rad/s", "m/s"),
    "acceleration": ("rad/s^2", "m/s^2"),
    "effort": ("Nm", "N"),
}


def claim_facts(cell: Cell, manager: ControllerManager, controller: Controller) -> Iterator[str]:
    """Yield interfaces, frame, unit, rate, time source, owner, failure behaviour and hardware of a claim."""
    device = cell.device(controller.device) if controller.device is not None else None
    rate = controller.update_rate_hz or manager.update_rate_hz
    yield ", ".join(controller.command_interfaces)
    yield (
        f"frame joints, unit {units(cell, controller)}, {shortest(rate)} Hz, time of the update loop on "
        f"{manager.host or 'its host'}"
    )
    owner = cell.spec.owners.responsibilities.command
    yield f"owner {owner}; on a violation: {controller.on_violation}; watchdog: {watchdog(cell, controller)}"
    if device is not None:
        state = "from start-up" if controller.active else "as an alternate, inactive at start-up"
        through = f"through {real_mover(device)}" if "real" in controller.targets else "on the mock alone"
        yield f"{through}; {state}; architecture: {device.spec.architecture}"


def driver_facts(cell: Cell, device: Device, driver: DeviceDriver) -> Iterator[str]:
    """Yield program, goals, owner and watchdog of what moves a device past every controller on real hardware."""
    safety = device.facts.safety
    goals = ", ".join(action for action, _ in driver.actions.values()) or "none declared"
    yield f"{driver.program}, on real hardware; no controller claims anything there"
    yield f"goals: {goals}; frame joints, on request, time of the driver"
    watched = (None if safety is None else safety.watchdog) or _NOT_STATED
    yield f"owner {cell.spec.owners.responsibilities.vendor_safety}; watchdog: {watched}"
    yield f"architecture: {device.spec.architecture}"


def stop_facts(cell: Cell) -> Iterator[str]:
    """Yield path, independence and owner of the physical stop, which is no message."""
    stop, recovery = cell.spec.safety.stop, cell.spec.safety.recovery
    independent = ", ".join(stop.independent_of) or "nothing stated"
    yield f"path {stop.path}, independent of {independent}; no message, frame or clock"
    yield (
        f"owner {cell.spec.owners.responsibilities.physical_stop}; recovery acknowledged by {recovery.acknowledge}, "
        f"owned by {recovery.owner}"
    )


def units(cell: Cell, controller: Controller) -> str:
    """Return the units of what a controller commands, each once."""
    types = {joint.name: joint.type for device in cell.devices for joint in device.joints}
    found = (
        _UNITS[kind][types[joint] == "prismatic"] if joint in types and kind in _UNITS else f"as {kind} of the device"
        for joint, _, kind in (name.rpartition("/") for name in controller.command_interfaces)
    )
    return ", ".join(dict.fromkeys(found))


def watchdog(cell: Cell, controller: Controller) -> str:
    """Return what stops the device when commands stay away, by its vendor."""
    safety = cell.device(controller.device).facts.safety if controller.device is not None else None
    return (safety.watchdog if safety is not None else None) or _NOT_STATED
