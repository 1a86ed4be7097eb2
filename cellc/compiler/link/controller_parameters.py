"""Everything that goes into a controller's own parameters, in the types that it declares, and what follows from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.device_interfaces import PluginUse
from cellc.compiler.cell.control import ControllerTopic
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.link.names import graph_name
from cellc.compiler.link.tolerances import Tolerances
from cellc.compiler.spec.control import ControllerSpec
from cellc.contract.vocabulary import Distro

# Parameters that the cell's safety rests on: written out even where they equal the default, which differs by
# distribution (Humble allows a nonzero velocity at the end of a trajectory) or hides a choice (partial goals).
_EXPLICIT = {
    "allow_partial_joints_goal": False,
    "allow_nonzero_velocity_at_trajectory_end": False,
    "action_monitor_rate": 20.0,
    "constraints.stopped_velocity_tolerance": 0.01,
}


def bind_parameters(
    kind: ControllerKind,
    plugin: PluginUse,
    written: ControllerSpec,
    joints: tuple[str, ...],
    claims: tuple[str, ...],
    states: tuple[str, ...],
    device: Device | None,
    tolerances: Tolerances,
    distro: Distro,
) -> dict[str, ParameterValue]:
    """Return the parameters, dots for nesting; what the user wrote by hand comes last and wins."""
    values: dict[str, ParameterValue] = {}
    if kind.joints_parameter is not None and joints:
        values[kind.joints_parameter] = joints[0] if kind.single_joint else joints
    if kind.interfaces_parameter is not None and claims:
        values[kind.interfaces_parameter] = claims if kind.interfaces_parameter.endswith("s") else claims[0]
    if _declares(kind, "command_interfaces", distro) and claims:
        values["command_interfaces"] = claims
    if _declares(kind, "state_interfaces", distro) and states:
        values["state_interfaces"] = states
    values |= {name: value for name, value in _EXPLICIT.items() if _declares(kind, name, distro)}
    values |= dict(_tolerances(kind, written, joints, tolerances, distro))
    values |= dict(_gripper(kind, device, tolerances, distro))
    values |= dict(_turning(kind, device, joints, distro))
    if written.update_rate is not None:
        values["update_rate"] = round(written.update_rate.si)
    return values | plugin.parameters | written.parameters


def bind_topics(
    kind: ControllerKind, namespace: str, full_name: str, parameters: Mapping[str, ParameterValue], distro: Distro
) -> Iterator[ControllerTopic]:
    """Yield the topics that a controller has with the parameters that it gets."""
    declared = kind.parameters_in(distro)
    for topic in kind.topics_with(parameters, distro):
        rate = None if topic.rate not in declared else parameters.get(topic.rate, declared[topic.rate].default)
        yield ControllerTopic(
            name=graph_name(namespace, full_name, topic.name),
            type=topic.type,
            publishes=topic.direction == "publish",
            declared=topic,
            rate_hz=float(rate) if isinstance(rate, (int, float)) else None,
        )


def _declares(kind: ControllerKind, name: str, distro: Distro) -> bool:
    return name in kind.parameters and kind.parameters[name].declared_in(distro)


def _tolerances(
    kind: ControllerKind, written: ControllerSpec, joints: tuple[str, ...], tolerances: Tolerances, distro: Distro
) -> Iterator[tuple[str, ParameterValue]]:
    if not _declares(kind, "constraints.goal_time", distro):
        return
    if written.goal_time is not None:
        yield "constraints.goal_time", float(written.goal_time.si)
    path, goal = tolerances.path or {}, tolerances.goal or {}
    for joint in joints:
        if joint in path:
            yield f"constraints.{joint}.trajectory", path[joint].value
        if joint in goal:
            yield f"constraints.{joint}.goal", goal[joint].value


def _turning(
    kind: ControllerKind, device: Device | None, joints: tuple[str, ...], distro: Distro
) -> Iterator[tuple[str, ParameterValue]]:
    """Yield that errors of joints without an end count the shorter way round; later controllers see it in the URDF."""
    if device is not None and _declares(kind, "gains.<joint>.angle_wraparound", distro):
        for joint in device.joints:
            if joint.type == "continuous" and joint.name in joints:
                yield f"gains.{joint.name}.angle_wraparound", True


def _gripper(
    kind: ControllerKind, device: Device | None, tolerances: Tolerances, distro: Distro
) -> Iterator[tuple[str, ParameterValue]]:
    if device is None or device.gripper is None:
        return
    if _declares(kind, "goal_tolerance", distro):
        stated = (tolerances.goal or {}).get(device.gripper.joint)
        yield "goal_tolerance", device.gripper.goal_tolerance if stated is None else stated.value
    if _declares(kind, "allow_stalling", distro):
        # Fingers that meet a part stand still before their goal: that is a grasp, not a failure.
        yield "allow_stalling", True
