"""When people power the drives of each device: before its driver starts, where that needs or takes it, or after it."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import CommandAuthority, GateCode, Moment


def commands_from_its_start(device: Device) -> bool:
    """Whether a device follows the computer from the start of its driver on."""
    hardware = device.control.hardware
    start = None if hardware is None else hardware.effects.get(Moment.INIT)
    return start is not None and start.authority is CommandAuthority.TAKEN


def enabled_in(device: Device) -> GateCode:
    """Return the gate in which people power a device and try its stop: before its driver, where that needs or takes it.

    It is the gate of the vendor's step that powers the drives.
    """
    powered = [step.gate for step in device.procedures.commissioning if step.powers]
    return min(powered, default=GateCode.G3 if commands_from_its_start(device) else GateCode.G5)


def enabled_early(graph: CellGraph) -> tuple[str, ...]:
    """Return the devices that people power, and whose stop they try, before the start of the drivers."""
    return tuple(device.name for device in _powered(graph) if enabled_in(device) is GateCode.G3)


def all_early(graph: CellGraph) -> bool:
    """Whether no drive is powered later."""
    return all(enabled_in(device) is GateCode.G3 for device in _powered(graph))


def has_drives(device: Device) -> bool:
    """Whether people power the drives of a device; a gripper has its power from its arm."""
    return bool(device.actuated_joints) and device.kind != "gripper"


def answers_when_powered(device: Device) -> bool:
    """Whether a device is silent on its network, and shows no firmware, until its drives have power."""
    return device.site.network is not None and device.site.network.powered


def _powered(graph: CellGraph) -> Iterator[Device]:
    return (device for device in graph.cell.devices if has_drives(device))
