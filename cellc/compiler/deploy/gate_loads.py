"""Lines of the gates about what the robot's own controller knows of its tool: payload, TCP, and the tool connector."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import Device
from cellc.compiler.deploy.enabling import answers_when_powered, enabled_in
from cellc.compiler.deploy.gate_motion import Values
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.numbers import positive_zero
from cellc.compiler.graph.cell_graph import CellGraph

_SAME = " Both commands must print the same pose, one from the robot and one from TF."
_UNSAID = "Enter it as the vendor's manual says, and record the values that the robot shows."


def loaded_devices(graph: CellGraph, *, powered: bool = False) -> Iterator[Values]:
    """Yield the payload of each robot that takes it before its drives are powered, or after that."""
    text = graph.cell.text
    for device in graph.cell.devices:
        if device.robot.payload is not None and answers_when_powered(device) is powered:
            payload = (*device.path, "payload")
            moments = text(*payload, "inertia")
            said = (
                f", inertia about that center {moments} (ixx iyy izz ixy ixz iyz)"
                if moments
                else ", inertia not stated"
            )
            stated = device.name, text(*payload, "mass"), text(*payload, "center_of_mass"), moments, said
            frame, gate = device.body.tool_frame or device.body.root_link, enabled_in(device)
            yield *stated, frame, device.robot.payload.set_by, device.procedures.payload_entry or _UNSAID, gate


def tool_centers(graph: CellGraph, *, powered: bool = False) -> Iterator[Values]:
    """Yield the TCP that the robot's own controller must have, and the command that shows it, as for the payload."""
    for device in graph.cell.devices:
        if device.robot.tcp is None or device.body.tool_frame is None or answers_when_powered(device) is not powered:
            continue
        pose = graph.frames.pose_in(device.robot.tcp, device.body.tool_frame)
        if pose is not None:
            xyz = _figures((1000.0 * value for value in pose.position), 2) + " mm"
            turn = _figures(pose.rotation_vector(), 4) + " rad"
            rpy = _figures(map(math.degrees, pose.rpy()), 2) + " deg"
            turned = f"roll pitch yaw {rpy}"
            if device.procedures.rotation_vector:
                turned = f"rotation vector {turn}, {turned}"
            frames, gate = (device.robot.tcp, device.body.tool_frame), enabled_in(device)
            command = _shows_center(graph, device)
            yield device.name, *frames, xyz, turn, rpy, turned, command, command and _SAME, gate


def tool_connectors(graph: CellGraph) -> Iterator[Values]:
    tools: dict[str, list[str]] = {}
    for tool in graph.cell.devices:
        if tool.site.connection is not None and tool.site.connection.through is not None:
            tools.setdefault(tool.site.connection.through, []).append(tool.name)
    for device in graph.cell.devices:
        if device.robot.tool_connector is not None:
            voltage = graph.cell.text(*device.path, "tool_connector", "voltage")
            yield device.name, voltage, ", ".join(tools.get(device.name, ())) or "every connected tool"


def _figures(values: Iterable[float], digits: int) -> str:
    return " ".join(f"{positive_zero(round(value, digits)):.{digits}f}" for value in values)


def _shows_center(graph: CellGraph, device: Device) -> str:
    """Return the command that prints the robot's own TCP; empty where no controller of the cell publishes it."""
    broadcaster = graph.once(_active_by_kind).get((device.robot.accepts.tcp_kind, device.name))
    if broadcaster is None:
        return ""
    shown = f"timeout 10 ros2 topic echo --once {broadcaster.full_name}/{device.robot.accepts.tcp_topic}"
    measured_in = str(broadcaster.parameters["frame_id"])
    tf = f"timeout 10 ros2 run tf2_ros tf2_echo {shell_word(measured_in)} {shell_word(device.robot.tcp or '')}"
    return f"{shown}\n{tf}"


def _active_by_kind(graph: CellGraph) -> Mapping[tuple[str | None, str | None], Controller]:
    """Return the first active controller of each kind and device."""
    active = (controller for controller in reversed(graph.cell.controllers) if controller.active)
    return {(controller.kind, controller.device): controller for controller in active}
