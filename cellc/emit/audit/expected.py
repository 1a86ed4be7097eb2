"""What must be found when the cell runs: nodes, topics, services, actions, TF publishers and parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.cell.cell import Cell
from cellc.cell.interface import Endpoint, Interface, InterfaceKind, Node, NodeSource
from cellc.deploy.files import QOS_OVERRIDES, controllers_file, is_planner, parameter_files, plans
from cellc.deploy.labels import interface_facts
from cellc.emit.audit.table import table
from cellc.formats.parameter_file import qos_parameters
from cellc.graph.device_topics import device_topics
from cellc.link.nodes import DESCRIPTION_PUBLISHER
from cellc.link.placeholders import placeholders


def nodes_section(cell: Cell) -> str:
    """Write every node with who answers for it."""
    return table(("node", "program", "host", "owner", "parameters"), _nodes(cell))


def interfaces_section(cell: Cell, kind: InterfaceKind) -> str:
    """Write the topics, services or actions, each with both ends."""
    ends = ("publishers", "subscribers") if kind is InterfaceKind.TOPIC else ("server", "clients")
    rows = (_interface(one) for one in cell.interfaces if one.kind is kind)
    return table(("name", "type", *ends, "contract"), rows)


def drivers_section(cell: Cell) -> str:
    """Write what the catalogue says that the devices' drivers offer beside what the spec names."""
    return table(("name", "kind", "type", "device"), _of_drivers(cell))


def tf_section(cell: Cell) -> str:
    """Write who publishes which edges of the frame tree."""
    publishers: dict[str, list[str]] = {}
    for frame in cell.frames:
        if frame.parent:
            publishers.setdefault(frame.authority, []).append(frame.name)
    return table(("publisher", "frames"), ((name, _code(frames)) for name, frames in publishers.items()))


def _nodes(cell: Cell) -> Iterator[tuple[str, ...]]:
    for node in cell.nodes:
        real = " (real target)" if node.real_only else ""
        program = f"{node.package}/{node.executable}{real}"
        yield f"`{node.full_name}`", program, node.host or "not stated", node.owner, _code(_parameters(cell, node))
    for manager in cell.managers:
        for one in manager.controllers:
            owner = cell.spec.owners.approvals.controller
            name = f"`{manager.namespace}/{one.name}`"
            yield name, one.plugin, manager.host or "not stated", owner, _code(one.parameters)


def _parameters(cell: Cell, node: Node) -> tuple[str, ...]:
    """Return the names of parameters, and the files of those that several nodes or controllers share."""
    files = {manager.node: controllers_file(cell, manager) for manager in cell.managers}
    if node.full_name in files:
        return (files[node.full_name],)
    if node.name == DESCRIPTION_PUBLISHER:
        return ("robot_description",)
    if node.source is NodeSource.STANDARD:
        return ("robot_description", "publish_frequency")
    planned = ("robot_description", "robot_description_semantic", *parameter_files(cell, "real"))
    overrides = (QOS_OVERRIDES,) if node.source is NodeSource.SPEC and qos_parameters(cell, node) else ()
    return (*node.parameters, *(planned if is_planner(node) and plans(cell) else ()), *overrides)


def _of_drivers(cell: Cell) -> Iterator[tuple[str, ...]]:
    named = {interface.name for interface in cell.interfaces}
    for device in cell.devices:
        for name, type_ in device_topics(cell, device).items():
            if name not in named:
                yield f"`{name}`", "topic", type_, device.name
        known = placeholders(device.name, device.prefix, device.spec, cell.spec)
        for service in device.facts.services:
            yield f"`{known.fill(service.name)}`", "service", service.type, device.name


def _interface(interface: Interface) -> tuple[str, ...]:
    first, *others = interface_facts(interface)
    facts = "; ".join([first.rpartition(", ")[2], *others])
    return f"`{interface.name}`", interface.type, _ends(interface.sources), _ends(interface.sinks), facts


def _ends(ends: tuple[Endpoint, ...]) -> str:
    shown = (f"{end.node} ({end.qos.reliability}, {end.qos.durability}, depth {end.qos.depth})" for end in ends)
    return ", ".join(dict.fromkeys(shown)) or "none"


def _code(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names) or "none"
