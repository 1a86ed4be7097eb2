"""Rules on programs of robots, on activation, and on power."""

from __future__ import annotations

import re

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import HardwareComponent
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.vocabulary import UNKNOWN, Moment


@rule(Severity.BLOCKER)
def drop_at_power_loss(graph: CellGraph) -> Findings:
    """Yield devices that hold something, may lose it without power, and name no person who accepts that."""
    for device in graph.cell.devices:
        switched = device.switched
        if (
            switched is None
            or switched.holds is None
            or switched.power_lost == "holds"
            or switched.accepted_by not in (None, UNKNOWN)
        ):
            continue
        unknown = f"it is not stated whether `{device.name}` holds its load when power is lost"
        message = unknown if switched.power_lost == UNKNOWN else f"`{device.name}` drops its load when power is lost"
        yield found(graph, (*device.path, "switching", "power_lost"), message)


@rule(Severity.ERROR)
def impossible_program(graph: CellGraph) -> Findings:
    """Yield devices whose controller has no such mode of starting a program."""
    for device in graph.cell.devices:
        program, modes = device.robot.program, device.robot.accepts.start_modes
        if program is None:
            continue
        path = (*device.path, "program")
        starter = "driver" if program.played_by == "driver" else "person"
        if not modes:
            advice = "delete `program:`, or say under `robot.program` of its `device.yaml` who can start it"
            yield found(
                graph,
                path,
                f"`program` has no effect on `{device.name}`: its set points pass through no program",
                advice,
            )
        elif (starter, program.mode) not in modes:
            allowed = " or ".join(f"`{mode}`" for by, mode in modes if by == starter) or "no mode"
            message = f"a {starter} starts the program of `{device.name}` in {allowed}, got `{program.mode}`"
            yield found(graph, (*path, "mode"), message)


@rule(Severity.BLOCKER)
def procedure_without_owner(graph: CellGraph) -> Findings:
    """Yield the procedures without an owner, in one finding."""
    if not any(controller.command_interfaces for controller in graph.cell.controllers):
        return
    missing = [item for item in graph.responsibilities.of_kind("procedure") if item.open]
    if missing:
        names = " and ".join(item.name for item in missing)
        message = f"no person is named for {names}"
        yield found(graph, missing[0].path, message)


@rule(Severity.ERROR)
def program_played_by_software(graph: CellGraph) -> Findings:
    """Yield programs that are started by what is no person, and not the driver that owns them."""
    cell = graph.cell
    software = (
        {node.name for node in cell.nodes} | {controller.name for controller in cell.controllers} | set(cell.hosts)
    )
    for device in cell.devices:
        if device.robot.program is not None and device.robot.program.played_by in software:
            played_by = device.robot.program.played_by
            message = f"the program of `{device.name}` must be started by a person, got `{played_by}` of this cell"
            yield found(graph, (*device.path, "program", "played_by"), message)


@rule(Severity.ERROR)
def refused_initial_state(graph: CellGraph) -> Findings:
    """Yield states of components that move at the start, that the vendor excludes, or that no step activates."""
    for device in graph.cell.devices:
        if device.control.initial_state is None:
            continue
        path = (*device.path, "initial_state")
        if device.control.hardware is None:
            yield found(
                graph, path, f"no controller manager starts `{device.name}`, because it has no hardware component"
            )
        elif refused := _refused_state(device, device.control.hardware):
            yield found(graph, path, refused)


def _refused_state(device: Device, hardware: HardwareComponent) -> str:
    """Return why a component must not start as stated; empty where it may."""
    said = f"`{device.name}` must not start `{device.control.initial_state}`:"
    if device.control.initial_state == "active":
        if not hardware.is_activation_known:
            return f"{said} the effect of its activation is not stated"
        if hardware.moves_as_it_is_activated:
            return f"{said} its activation {re.split('[;.] ', hardware.effects[Moment.ACTIVATE].does)[0]}"
    if hardware.direct_activation and device.control.initial_state != hardware.initial_state:
        return f"{said} it must become active in one call from `{hardware.initial_state}`"
    return ""


@rule(Severity.ERROR)
def tool_voltage_mismatch(graph: CellGraph) -> Findings:
    """Yield tools on the connector of another robot, of one without settings, or of one with another voltage."""
    for device in graph.cell.devices:
        link = device.site.connection
        if link is None or link.through is None:
            continue
        path = (*device.path, "connection", "through")
        robot = graph.cell.device(link.through)
        place = (*robot.path, "tool_connector")
        if device.name not in _hanging(graph, robot):
            message = f"`{device.name}` must be attached to `{robot.name}`, whose tool connector powers it"
            yield found(graph, path, message, "name the robot that carries it")
        if robot.robot.tool_connector is None:
            message = f"`{robot.name}` must have a `tool_connector`, because it powers `{device.name}`"
            yield found(graph, path, message, f"write `tool_connector` of `{robot.name}` with the voltage of its tool")
        elif device.robot.plug is not None and device.robot.plug.voltage_v != robot.robot.tool_connector.voltage_v:
            given = f"{robot.robot.tool_connector.voltage_v:g} V of `{robot.name}`"
            message = f"the tool connector must give `{device.name}` {device.robot.plug.voltage_v:g} V, got {given}"
            related = (Related("stated here", graph.cell.locate(*place, "voltage")),)
            yield found(graph, path, message, related=related)


def _hanging(graph: CellGraph, robot: Device) -> set[str]:
    """Return what a robot carries, and what hangs on that."""
    carried: set[str] = set()
    left = [*robot.mount.carries]
    while left:
        name = left.pop()
        if name not in carried:
            carried.add(name)
            left += graph.cell.device(name).mount.carries
    return carried


@rule(Severity.BLOCKER)
def unknown_activation(graph: CellGraph) -> Findings:
    """Yield devices without a stated effect of their activation, or of the start of their driver."""
    for device in graph.cell.devices:
        for moment in device.control.unknown_effects:
            message = f"it is not stated what {moment} of `{device.name}` moves"
            yield found(graph, (*device.path, "model"), message)
