"""Rules on parameters that no program reads, or that replace what the cell states elsewhere."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from cellc.compiler.catalog.parameter_facts import ParameterFacts, is_named, named_part
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.cell.hardware import HardwareComponent, InterfaceGroup
from cellc.compiler.cell.interface import Node
from cellc.compiler.graph.stated_parameters import (
    StatedParameter,
    is_of_every_node,
    of_program,
    program_parameters,
    stated_parameters,
)
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule
from cellc.contract.diagnostics.nearest import is_slip


@rule(Severity.ERROR)
def parameter_of_nothing(graph: CellGraph) -> Findings:
    """Yield parameters that are named for a joint of no such controller, or for a group that the cell does not have."""
    for parameter in stated_parameters(graph.cell):
        yield from _unknown_names(graph, parameter)
        name = _filled(graph.cell, parameter, parameter.name)
        named = named_part(parameter.key, name) if parameter.facts is not None else None
        known, what = _known(graph.cell, parameter)
        if named is None or not known or named in known:
            continue
        message = (
            f"`{parameter.name}` of `{parameter.owner}` is for `{named}`, but there is no such name among its {what}"
        )
        yield found(graph, parameter.path, message, did_you_mean(named, known, what))


def _filled(cell: Cell, parameter: StatedParameter, text: str) -> str:
    """Return a text with the prefix of the controller's device where it has a placeholder for it."""
    device = None if parameter.controller is None else parameter.controller.device
    return text if device is None else text.replace("{prefix}", cell.device(device).body.prefix)


def _unknown_names(graph: CellGraph, parameter: StatedParameter) -> Findings:
    what = None if parameter.facts is None else parameter.facts.names
    for path, item in parameter.items() if what is not None else ():
        known = _names(graph.cell, what or "", parameter.controller)
        if item and _filled(graph.cell, parameter, str(item)) not in known:
            message = f"`{parameter.name}` of `{parameter.owner}` must be the name of a {what}, got `{item}`"
            yield found(graph, path, message, did_you_mean(str(item), known, f"{what}s"))


def _names(cell: Cell, what: str, controller: Controller | None) -> frozenset[str]:
    """Return the names of what there is: frames, or what devices under the manager of a controller export."""
    if what == "frame":
        return frozenset(frame.name for frame in cell.frames)
    manager = next((manager for manager in cell.managers if controller in manager.controllers), None)
    devices = [cell.device(name) for name in (() if manager is None else manager.devices)]
    field = f"{what.replace(' ', '_')}s"
    owners: list[DeviceJoint | InterfaceGroup] = [joint for device in devices for joint in device.joints]
    groups = [group for device in devices if device.control.hardware for group in _groups(device.control.hardware)]
    return frozenset(f"{owner.name}/{name}" for owner in [*owners, *groups] for name in getattr(owner, field))


def _groups(hardware: HardwareComponent) -> tuple[InterfaceGroup, ...]:
    return *hardware.sensors, *hardware.gpios


def _known(cell: Cell, parameter: StatedParameter) -> tuple[tuple[str, ...], str]:
    """Return the names that may stand for the placeholder of a parameter, and what they are; none where any may."""
    if "<group>" in parameter.key:
        return tuple(group.name for group in cell.groups), "groups"
    if "<joint>" in parameter.key or "<dof_names>" in parameter.key:
        if parameter.controller is not None:
            return parameter.controller.joints, "joints"
        return tuple(joint.name for device in cell.devices for joint in device.joints), "joints"
    return (), ""


@rule(Severity.WARNING, assumes=("parameter-of-nothing",))
def parameter_over_cell(graph: CellGraph) -> Findings:
    """Yield parameters that state again, and replace, what a key of the spec states."""
    for parameter in stated_parameters(graph.cell):
        key = None if parameter.facts is None else parameter.facts.key
        if key is None or parameter.value in _by_key(parameter, key):
            continue
        message = f"`{parameter.name}` of `{parameter.owner}` replaces what the key `{key}` states"
        advice = f"state it as `{key}`, and delete this line"
        yield found(graph, parameter.path, f"{message}, which alone is checked", advice)


def _by_key(parameter: StatedParameter, key: str) -> tuple[object, ...]:
    """Return what a controller has by a key, in each form that a parameter may give it."""
    controller, joint = parameter.controller, named_part(parameter.key, parameter.name) or ""
    if controller is None:
        return ()
    if key == "joints":
        return controller.joints, *controller.joints[: 1 if len(controller.joints) == 1 else 0]
    if key == "command_interfaces":
        kinds = tuple(dict.fromkeys(claim.rpartition("/")[2] for claim in controller.command_interfaces))
        return kinds, *kinds[: 1 if len(kinds) == 1 else 0]
    tolerances = controller.path_tolerance if key == "path_tolerance" else controller.goal_tolerance
    figure = None if tolerances is None else tolerances.get(joint)
    stated = {"goal_time": controller.goal_time_s, "update_rate": controller.update_rate_hz}
    return (stated.get(key, None if figure is None else figure.value),)


@rule(Severity.ERROR)
def unknown_node_parameter(graph: CellGraph) -> Findings:
    """Yield parameters that the known program of a node does not read in the distribution of the cell."""
    for node in graph.cell.nodes:
        if not node.parameters or not graph.cell.states(*node.path, "parameters"):
            continue
        declared = program_parameters(graph.cell, node)
        for parameter in stated_parameters(graph.cell) if declared else ():
            if parameter.path[:-1] != (*node.path, "parameters") or parameter.facts is not None:
                continue
            near = _unread(node, parameter.name, declared)
            if near is not None:
                message = f"`{node.package}/{node.executable}` has no parameter `{parameter.name}`"
                advice = did_you_mean(parameter.name, near, "parameters")
                yield found(graph, parameter.path, f"{message} in {graph.cell.distro}", advice)


def _unread(node: Node, name: str, declared: Mapping[str, ParameterFacts]) -> Iterable[str] | None:
    """Return what may be meant by a name that nothing reads; None where a plugin may read it."""
    if is_of_every_node(name):
        return None
    rows = of_program(node)
    if any(row.closed and name.startswith(row.prefix) for row in rows):
        return declared
    for row in rows:
        if f"{row.prefix}{name}" in declared:
            return (f"{row.prefix}{name}",)
        if any(is_named(f"{row.prefix}{known}", name) or known.endswith(f">.{name}") for known in row.parameters):
            return declared
    slips = [known for known in declared if is_slip(name, known)]
    return slips or None
