"""The cell as one sentence (chapter 4, section 1): what is missing from it is an audit item."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.control import Controller
from cellc.cell.frame import FrameKind
from cellc.cell.interface import Interface, InterfaceKind
from cellc.deploy.labels import real_mover


def bringup_sentence(cell: Cell) -> str:
    """Return who tells what to whom, from the sensors to the drives and back to the stop."""
    clauses = [
        *_streams(cell),
        *_dynamic_frames(cell),
        *_actions(cell),
        *_managers(cell),
        *_drives(cell),
        _stop(cell),
    ]
    text = "; ".join(clauses)
    return text[0].upper() + text[1:] + "."


def _written(cell: Cell, kind: InterfaceKind) -> Iterator[Interface]:
    return (interface for interface in cell.interfaces if interface.kind is kind and not interface.derived)


def _streams(cell: Cell) -> Iterator[str]:
    for topic in _written(cell, InterfaceKind.TOPIC):
        frame = f" in {topic.frame}" if topic.frame else ""
        yield f"{_names(topic, 'sources')} publishes `{topic.name}`{frame} to {_names(topic, 'sinks')}"


def _dynamic_frames(cell: Cell) -> Iterator[str]:
    for frame in cell.frames:
        if frame.kind is FrameKind.DYNAMIC:
            yield f"{frame.authority} says where {frame.name} is in {frame.parent}, at the stamp of its observation"


def _actions(cell: Cell) -> Iterator[str]:
    for action in _written(cell, InterfaceKind.ACTION):
        yield f"{_names(action, 'sinks')} asks {_names(action, 'sources')} through `{action.name}`"
    for controller in cell.controllers:
        if controller.action is not None:
            client = controller.client or "a client that the spec does not name"
            yield f"{client} sends goals to {controller.label} through `{controller.action}`{_instead(controller)}"


def _instead(controller: Controller) -> str:
    """Return where the goals go on real hardware, for a controller that is not there."""
    other = controller.stand_in
    return "" if other is None else f", on real hardware to {other.node} through `{other.action}`"


def _managers(cell: Cell) -> Iterator[str]:
    for manager in cell.managers:
        for device in map(cell.device, manager.devices):
            through = real_mover(device)
            if device.hardware is not None and "real" in device.hardware.targets:
                yield f"controller manager {manager.name} writes to {device.name} through {through}"
            else:
                yield f"no controller manager writes to {device.name} on real hardware, where {through} moves it"


def _drives(cell: Cell) -> Iterator[str]:
    for device in cell.devices:
        if device.hardware is not None:
            yield f"the vendor controller of {device.name} decides what reaches the drives"


def _stop(cell: Cell) -> str:
    stop = cell.safety.stop
    return f"{stop.authority} stops the cell by a path ({stop.path}) that no software is part of"


def _names(interface: Interface, side: str) -> str:
    ends = interface.sources if side == "sources" else interface.sinks
    return " and ".join(end.node for end in ends) or "nobody"
