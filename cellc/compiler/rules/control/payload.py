"""Rules on what an arm carries, and on what its controller knows of it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

from cellc.compiler.cell.device import Connection, Device
from cellc.compiler.cell.robot import Payload, ToolFacts, ToolSerial
from cellc.compiler.rules.carried import farthest_link
from cellc.compiler.rules.described import in_its_file
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.transforms import Vector3

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
        if payload is None:
            continue
        wrong = (_wrong_center(payload, reach_m) if reach_m > 0.0 else "") or _off_the_tools(graph, device, payload)
        if wrong:
            path = (*device.path, "payload", "center_of_mass")
            message = f"the center of mass of the payload of `{device.name}` must lie between the flange and"
            far_m = _BEYOND_TOOL_M + (reach_m or math.hypot(*(_tip(graph, device) or (0.0, 0.0, 0.0))))
            message += f" {far_m * 1e3:.0f} mm from it, got {graph.cell.text(*path)}, {wrong}"
            related = tuple(Related("carried here", graph.cell.device(name).span) for name in device.mount.carries)
            yield found(graph, path, message, related=related)


def _wrong_center(payload: Payload, reach_m: float) -> str:
    far_m = math.hypot(*payload.center_of_mass)
    if far_m > reach_m + _BEYOND_TOOL_M:
        return "beyond the end of the tools"
    if payload.center_of_mass[2] < -_IN_THE_FLANGE_M and reach_m > _LONG_M:
        return "behind the flange"
    return "within the flange" if far_m < _IN_THE_FLANGE_M and reach_m > _LONG_M else ""


_OFF_M, _OFF_SHARE = 0.03, 0.2
"""By which a center may be beside that of the tools: couplings weigh, and masses of descriptions are rounded."""
_KNOWN = 0.5
"""Share of a payload of which descriptions must tell: what else hangs there may be anywhere."""


def _off_the_tools(graph: CellGraph, arm: Device, payload: Payload) -> str:
    """Say how far a center is from the line from that of the tools, by their descriptions, to that with a part."""
    bodies = [
        (inertial.mass, pose.apply(inertial.pose.position))
        for link, inertial in graph.cell.tool_masses(arm)
        if (pose := graph.frames.pose_in(link, arm.body.tool_frame or "")) is not None
    ]
    mass, tip = sum(mass for mass, _ in bodies), _tip(graph, arm)
    if mass < _KNOWN * payload.mass_kg or tip is None or payload.mass_kg < mass - _ROUNDING_KG:
        return ""
    of_tools = _weighted(bodies, mass)
    with_part = _weighted([(mass, of_tools), (max(payload.mass_kg - mass, 0.0), tip)], max(payload.mass_kg, mass))
    off = _distance(payload.center_of_mass, of_tools, with_part)
    in_the_flange = not any(payload.center_of_mass) and math.hypot(*of_tools) > _OFF_M
    if off <= _OFF_M + _OFF_SHARE * math.hypot(*tip) and not in_the_flange:
        return ""
    place = " ".join(f"{value * 1e3:.0f}" for value in of_tools)
    return f"{off * 1e3:.0f} mm from that of the tools by their descriptions, {place} mm"


def _tip(graph: CellGraph, arm: Device) -> Vector3 | None:
    """Return where a part is held: at the farthest link of the tools, else at the TCP, or at the arm's own fingers."""
    place = farthest_link(graph, arm)
    tcp = None if arm.robot.tcp is None else graph.frames.pose_in(arm.robot.tcp, arm.body.tool_frame or "")
    if place is not None or tcp is not None:
        return place or (None if tcp is None else tcp.position)
    poses = (graph.frames.pose_in(name, arm.body.tool_frame or "") for name, _ in graph.cell.tool_masses(arm))
    return max((pose.position for pose in poses if pose is not None), key=lambda at: math.hypot(*at), default=None)


def _weighted(bodies: Sequence[tuple[float, Vector3]], mass: float) -> Vector3:
    x, y, z = (sum(kg * place[axis] for kg, place in bodies) / mass for axis in range(3))
    return x, y, z


def _distance(point: Vector3, start: Vector3, end: Vector3) -> float:
    """Return how far a point is from a line between two others, m."""
    along = [b - a for a, b in zip(start, end, strict=True)]
    square = sum(value * value for value in along)
    share = sum((p - a) * d for p, a, d in zip(point, start, along, strict=True)) / square if square > 0.0 else 0.0
    share = min(1.0, max(0.0, share))
    return math.dist(point, [a + share * d for a, d in zip(start, along, strict=True)])


def _reach_m(graph: CellGraph, arm: Device) -> float:
    """Return how far the links of what an arm carries reach from its tool frame, 0 where that is not known."""
    place = farthest_link(graph, arm)
    return 0.0 if place is None else math.hypot(*place)


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
            related = enters(graph, "the payload", (*device.path, "payload", "mass"))
            yield found(graph, path, message, related=related)


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
            yield found(graph, path, message, related=in_its_file(device, "limits", "payload", "value"))


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
        elif serial is not None and speaks is not None and link.port != serial.port and not _is_read(graph, robot):
            message = f"`{device.name}` must be at `{serial.port}`, to which `{robot.name}` forwards its serial line"
            related = (Related("forwarded here", graph.cell.locate(*robot.path, "tool_connector", "serial", "port")),)
            port = (*device.path, "connection", "port")
            yield found(graph, port, f"{message}, got `{link.port}`", related=related)
        elif serial is not None and link.port == serial.port:
            related = (Related("forwarded here", graph.cell.locate(*robot.path, "tool_connector", "serial")),)
            for message in (*_elsewhere(device, link, robot), *_differences(device, speaks, serial)):
                yield found(graph, path, message, related=related)


def _is_read(graph: CellGraph, robot: Device) -> bool:
    """Tell whether some device opens the serial line that a robot forwards."""
    serial = None if robot.robot.tool_connector is None else robot.robot.tool_connector.serial
    links = [device.site.connection for device in graph.cell.devices]
    return serial is not None and any(link is not None and link.port == serial.port for link in links)


def _elsewhere(device: Device, link: Connection, robot: Device) -> Iterator[str]:
    host = robot.site.host
    if link.host != host:
        yield f"`{device.name}` must be reached from `{host}`, where its port is forwarded, got `{link.host}`"


def _differences(device: Device, speaks: Mapping[str, str | int] | None, serial: ToolSerial) -> Iterator[str]:
    for key, wanted in (speaks or {}).items():
        if (got := getattr(serial, key)) != wanted:
            yield f"`{key}` of the tool connector must be {wanted} for `{device.name}`, got {got}"
