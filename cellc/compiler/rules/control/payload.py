"""Rules on what an arm carries, and on what its controller knows of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.cell.device import Connection, Device
from cellc.compiler.cell.robot import Payload, ToolFacts, ToolSerial
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_IN_THE_FLANGE_M = 0.005
_LONG_M = 0.05
"""A tool that reaches further than this has its center of mass outside of the flange."""
_BEYOND_TOOL_M = 0.05
"""A part that is held has its center of mass beyond the end of the tool by at most as much."""


@rule(Severity.WARNING)
def implausible_center_of_mass(graph: CellGraph) -> Findings:
    """Yield centers of mass in the flange, behind it, or beyond the end of what the arm carries."""
    for device in graph.cell.devices:
        payload, reach_m = device.robot.payload, _reach_m(graph, device)
        if payload is None or reach_m <= 0.0:
            continue
        wrong = _wrong_center(payload, reach_m)
        if wrong:
            path = (*device.path, "payload", "center_of_mass")
            message = f"the center of mass of the payload of `{device.name}` must lie between the flange and"
            message += f" {(reach_m + _BEYOND_TOOL_M) * 1e3:.0f} mm from it, got {graph.cell.text(*path)}, {wrong}"
            related = tuple(Related("carried here", graph.cell.device(name).span) for name in device.mount.carries)
            yield found(graph, path, message, related=related)


def _wrong_center(payload: Payload, reach_m: float) -> str:
    far_m = math.hypot(*payload.center_of_mass)
    if far_m > reach_m + _BEYOND_TOOL_M:
        return "beyond the end of the tools"
    if payload.center_of_mass[2] < -_IN_THE_FLANGE_M and reach_m > _LONG_M:
        return "behind the flange"
    return "within the flange" if far_m < _IN_THE_FLANGE_M and reach_m > _LONG_M else ""


def _reach_m(graph: CellGraph, arm: Device) -> float:
    """Return how far the links of what an arm carries reach from its tool frame, 0 where that is not known."""
    links = (link.name for name in arm.mount.carries for link in graph.cell.device(name).body.description.links)
    poses = [graph.frames.pose_in(name, arm.body.tool_frame or "") for name in links]
    return max((math.hypot(*pose.position) for pose in poses if pose is not None), default=0.0)


_ROUNDING_KG = 0.05  # masses of descriptions are rounded


@rule(Severity.ERROR)
def load_beyond_payload(graph: CellGraph) -> Findings:
    """Yield loads that no service tells, and those that leave less of the payload than the tool weighs."""
    for device in graph.cell.devices:
        payload = device.robot.payload
        if payload is None or payload.load is None:
            continue
        path = (*device.path, "payload", "load")
        if not device.robot.accepts.load_service:
            yield found(graph, path, f"no service sets a load of `{device.name}` beside its tool")
            continue
        tools = (graph.cell.device(name) for name in device.mount.carries)
        links = (link for tool in tools for link in tool.body.description.links)
        tool_kg = sum(link.inertial.mass for link in links if link.inertial is not None)
        if payload.load.mass_kg + tool_kg > payload.mass_kg + _ROUNDING_KG:
            stated = f"{payload.load.mass_kg:g} kg beside a tool of {tool_kg:.3g} kg"
            message = f"the load of `{device.name}` must fit its payload of {payload.mass_kg:g} kg, got {stated}"
            yield found(graph, path, message)


@rule(Severity.BLOCKER)
def missing_payload(graph: CellGraph) -> Findings:
    """Yield arms that carry devices and state no payload."""
    for device in graph.cell.devices:
        if device.kind == "arm" and device.mount.carries and device.robot.payload is None:
            names = ", ".join(f"`{name}`" for name in device.mount.carries)
            message = f"`{device.name}` carries {names}, but its payload is not stated"
            yield found(graph, device.path, message)


@rule(Severity.ERROR)
def payload_above_limit(graph: CellGraph) -> Findings:
    """Yield payloads above that of the device."""
    for device in graph.cell.devices:
        payload, limit_kg = device.robot.payload, device.limits.payload_limit_kg
        if payload is not None and limit_kg is not None and payload.mass_kg > limit_kg:
            path = (*device.path, "payload", "mass")
            message = f"the payload of `{device.name}` must be at most {limit_kg:g} kg, got {graph.cell.text(*path)}"
            yield found(graph, path, message)


@rule(Severity.BLOCKER)
def payload_lighter_than_tool(graph: CellGraph) -> Findings:
    """Yield arms whose payload is below the sum of masses of what they carry."""
    for device in graph.cell.devices:
        payload = device.robot.payload
        if payload is None or device.kind != "arm":
            continue
        mass = graph.cell.carried_mass_kg(device)
        if mass > payload.mass_kg + _ROUNDING_KG:
            path = (*device.path, "payload", "mass")
            message = f"`{device.name}` carries {mass:.3g} kg, but its payload is {graph.cell.text(*path)}"
            yield found(graph, path, message, f"write at least {mass:.3g} kg")


@rule(Severity.BLOCKER)
def payload_set_too_late(graph: CellGraph) -> Findings:
    """Yield payloads set by a service that is missing, or is refused until after the brakes open."""
    for device in graph.cell.devices:
        if device.robot.payload is None or device.robot.payload.set_by != "service":
            continue
        path = (*device.path, "payload", "set_by")
        if not device.robot.accepts.payload_service:
            yield found(graph, path, f"no service sets the payload of `{device.name}`")
        elif device.robot.accepts.start_modes and (
            device.robot.program is None or device.robot.program.mode == "local"
        ):
            message = f"`{device.name}` is in local mode, and refuses a payload by service before its program runs"
            yield found(graph, path, message)


@rule(Severity.ERROR)
def refused_tool_connector(graph: CellGraph) -> Findings:
    """Yield connectors of robots that have none, and values that they do not give."""
    for device in graph.cell.devices:
        stated, has = device.robot.tool_connector, device.robot.accepts.tool_facts
        if stated is None:
            continue
        path = (*device.path, "tool_connector")
        if has is None:
            yield found(graph, path, f"`{device.name}` has no tool connector that its driver sets")
            continue
        if stated.voltage_v not in has.voltages_v:
            given = _listed(f"{value:g} V" for value in has.voltages_v)
            message = f"the tool connector of `{device.name}` must give {given}, got {stated.voltage_v:g} V"
            yield found(graph, (*path, "voltage"), message)
        if stated.serial is not None and not has.has_serial:
            yield found(graph, (*path, "serial"), f"the tool connector of `{device.name}` has no serial line")
        elif stated.serial is not None:
            for key, wanted, got in _refused_connector(stated.serial, has):
                message = f"`{key}` of the tool connector of `{device.name}` must be {wanted}, got {got}"
                yield found(graph, (*path, "serial", key), message)


def _refused_connector(stated: ToolSerial, has: ToolFacts) -> Iterator[tuple[str, str, str]]:
    """Yield each setting that the robot does not have, what it has, and what is written."""
    for key, allowed in has.settings.items():
        if getattr(stated, key) not in allowed:
            yield key, _listed(map(str, allowed)), str(getattr(stated, key))
    for key, (least, most) in has.spans.items():
        value = getattr(stated, key)
        if value is not None and not least <= value <= most:
            yield key, f"from {least:g} to {most:g}", f"{value:g}"


def _listed(names: Iterable[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last


@rule(Severity.ERROR)
def tool_serial_mismatch(graph: CellGraph) -> Findings:
    """Yield tools that speak a serial line which is not forwarded, not to their computer, or set otherwise."""
    for device in graph.cell.devices:
        link, speaks = device.site.connection, None if device.robot.plug is None else device.robot.plug.serial
        if link is None or link.through is None or link.address is not None:
            continue
        path = (*device.path, "connection", "through")
        robot = graph.cell.device(link.through)
        serial = None if robot.robot.tool_connector is None else robot.robot.tool_connector.serial
        if serial is None and speaks is not None and link.port is None and robot.robot.tool_connector is not None:
            message = f"`{device.name}` must have a serial port: the tool connector of `{robot.name}` forwards none"
            yield found(graph, path, message, f"write `serial` of the tool connector of `{robot.name}`, or a `port`")
        elif serial is not None and link.port == serial.port:
            related = (Related("forwarded here", graph.cell.locate(*robot.path, "tool_connector", "serial")),)
            for message in (*_elsewhere(device, link, robot), *_differences(device, speaks, serial)):
                yield found(graph, path, message, related=related)


def _elsewhere(device: Device, link: Connection, robot: Device) -> Iterator[str]:
    host = robot.site.host
    if link.host != host:
        yield f"`{device.name}` must be reached from `{host}`, where its port is forwarded, got `{link.host}`"


def _differences(device: Device, speaks: Mapping[str, str | int] | None, serial: ToolSerial) -> Iterator[str]:
    for key, wanted in (speaks or {}).items():
        if (got := getattr(serial, key)) != wanted:
            yield f"`{key}` of the tool connector must be {wanted} for `{device.name}`, got {got}"
