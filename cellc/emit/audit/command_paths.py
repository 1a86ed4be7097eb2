"""Every way along which something is commanded: frame, unit, rate, time source, QoS, watchdog, failure behaviour."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.deploy.labels import frame_label, interface_facts, units, watchdog
from cellc.emit.audit.table import table
from cellc.formats.numbers import shortest
from cellc.graph.cell_graph import CellGraph

_NOT_STATED = "not stated"


def owners_section(graph: CellGraph) -> str:
    """Write who owns each command interface, and who tells that owner what to do."""
    return table(("command interface", "controller", "commanded by", "owner"), _owners(graph.cell))


def command_section(graph: CellGraph) -> str:
    """Write the command paths: through controllers down to joints, and the actions above them."""
    head = ("path", "frame", "unit", "rate", "time source", "QoS", "watchdog", "on failure")
    return table(head, [*_requests(graph.cell), *_controllers(graph.cell)])


def _owners(cell: Cell) -> Iterator[tuple[str, ...]]:
    people = {node.name: node.owner for node in cell.nodes}
    for controller in cell.controllers:
        for name in controller.command_interfaces:
            client = controller.client or "nobody"
            state = "" if controller.active else " (inactive)"
            yield f"`{name}`", f"{controller.label}{state}", client, people.get(client, _NOT_STATED)


def _requests(cell: Cell) -> Iterator[tuple[str, ...]]:
    served = {controller.action for controller in cell.controllers}
    for one in cell.interfaces:
        if one.kind is InterfaceKind.ACTION and one.name not in served:
            ends = f"{_names(one.sinks)} → `{one.name}` → {_names(one.sources)}"
            time = one.time_source or _NOT_STATED
            qos = _qos((*one.sinks, *one.sources))
            yield (
                ends,
                frame_label(one),
                one.unit or "as the type",
                "on request",
                time,
                qos,
                "none",
                _failure(one),
            )


def _controllers(cell: Cell) -> Iterator[tuple[str, ...]]:
    actions = {one.name: one for one in cell.interfaces}
    for manager in cell.managers:
        for controller in manager.controllers:
            if controller.command_interfaces:
                yield _controller(cell, manager, controller, actions.get(controller.action or ""))


def _controller(
    cell: Cell, manager: ControllerManager, controller: Controller, action: Interface | None
) -> tuple[str, ...]:
    device = next((one for one in cell.devices if one.name == controller.device), None)
    hardware = "its hardware" if device is None or device.hardware is None else device.hardware.name
    rate = controller.update_rate_hz or manager.update_rate_hz
    behaviour = "" if action is None else f"; {_failure(action)}"
    name = controller.action or controller.full_name
    return (
        f"{controller.client or 'nobody'} → `{name}` → {controller.label} → {hardware}",
        (action.frame if action is not None else None) or "joints",
        units(cell, controller),
        f"{shortest(rate)} Hz",
        (action.time_source if action is not None else None) or f"clock of {manager.host or 'its host'}",
        _NOT_STATED if action is None else _qos((*action.sinks, *action.sources)),
        watchdog(cell, controller),
        f"on violation {controller.on_violation}{behaviour}",
    )


def _failure(interface: Interface) -> str:
    return list(interface_facts(interface))[2].partition("; ")[2]


def _qos(ends: tuple[Endpoint, ...]) -> str:
    texts = (f"{end.qos.reliability}, {end.qos.durability}, depth {end.qos.depth}" for end in ends)
    return "; ".join(dict.fromkeys(texts)) or _NOT_STATED


def _names(ends: tuple[Endpoint, ...]) -> str:
    return ", ".join(dict.fromkeys(end.node for end in ends)) or "nobody"
