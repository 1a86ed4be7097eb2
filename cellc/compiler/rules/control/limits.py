"""Rules on the limits of joints, and on the share of them that a cell uses."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.described import described
from cellc.compiler.rules.excuses import spared
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.quantities import SMALLEST
from cellc.contract.vocabulary import Behavior


@rule(Severity.BLOCKER)
def assumed_joint_limit(graph: CellGraph) -> Findings:
    """Yield devices with joints of which a limit has no source."""
    for device in graph.cell.devices:
        assumed = _assumed_limits(device)
        if assumed:
            named = ", ".join(f"`{key}` of {_shown(joints)}" for key, joints in assumed.items())
            message = f"limits of `{device.name}` are assumed: {named}"
            first = [joints[0] for joints in assumed.values()]
            places = described(graph, [f"{device.body.prefix}{name}" for name in first])
            yield found(graph, (*device.path, "model"), message, related=places)


def _assumed_limits(device: Device) -> dict[str, list[str]]:
    """Return the keys of the limits that are assumed, each with its joints."""
    joints: dict[str, list[str]] = {}
    for joint in device.actuated_joints:
        for key in joint.assumed:
            joints.setdefault(key, []).append(joint.local_name)
    return joints


def _shown(joints: list[str]) -> str:
    return f"`{joints[0]}`" if len(joints) == 1 else f"`{joints[0]}` and {len(joints) - 1} more"


@rule(Severity.ERROR)
def assumed_speed_scaling(graph: CellGraph) -> Findings:
    """Yield controllers that read a scaling factor though their device has none."""
    scaling = {device.name for device in graph.cell.devices if device.control.speed_scaling is not None}
    for controller in graph.cell.controllers:
        reads = controller.behavior is Behavior.SCALED_JOINT_TRAJECTORY or bool(
            controller.parameters.get("speed_scaling.state_interface")
        )
        if reads and controller.device is not None and controller.device not in scaling:
            message = f"`{controller.name}` follows a speed scaling that `{controller.device}` does not have"
            yield found(graph, controller.path, message)


@rule(Severity.ERROR)
def limit_share_above_full(graph: CellGraph) -> Findings:
    """Yield shares above 100 %."""
    for device, name, share in _shares(graph):
        if share > 1.0:
            path = (*device.path, "limits", name)
            message = f"the {name} share of `{device.name}` must be at most 100 %, got {graph.cell.text(*path)}"
            yield found(graph, path, message)


@rule(Severity.ERROR)
def limit_share_of_nothing(graph: CellGraph) -> Findings:
    """Yield shares of zero and below, and those that leave a joint less than the mock counts with."""
    for device, name, share in _shares(graph):
        path = (*device.path, "limits", name)
        got = f"got {graph.cell.text(*path)}"
        if share <= 0.0:
            yield found(graph, path, f"the {name} share of `{device.name}` must be above zero, {got}")
            continue
        for joint in device.actuated_joints:
            figure = getattr(joint, name)
            if figure is not None and figure < SMALLEST <= figure / share:
                message = f"the {name} share of `{device.name}` must leave `{joint.name}` at least {SMALLEST:g}"
                yield found(graph, path, f"{message} in SI units, {got}, which is {figure:.3g}")
                break


def _shares(graph: CellGraph) -> Iterator[tuple[Device, str, float]]:
    """Yield each share of its limits that a cell gives to a device."""
    for device in graph.cell.devices:
        yield device, "velocity", device.limits.limit_shares.velocity
        yield device, "acceleration", device.limits.limit_shares.acceleration


@rule(Severity.ERROR, assumes=("missing-joint-limits", "limit-share-of-nothing"))
def missing_velocity_limit(graph: CellGraph) -> Findings:
    """Yield joints with a command interface and without a velocity limit above zero."""
    for device in graph.cell.devices:
        for joint in device.actuated_joints:
            moves = joint.velocity is not None and joint.velocity >= SMALLEST
            if not moves and not spared(graph, device, joint.name, "missing-velocity-limit"):
                stated = "no velocity limit" if joint.velocity is None else f"a velocity limit of {joint.velocity:g}"
                message = f"joint `{joint.name}` has {stated}"
                yield found(graph, (*device.path, "model"), message, related=described(graph, [joint.name]))


_ROUNDING = 1.001


@rule(Severity.WARNING, assumes=("limit-share-above-full",))
def speed_of_some_positions(graph: CellGraph) -> Findings:
    """Yield devices with a joint that may be faster than the device allows it everywhere, once each."""
    for device in graph.cell.devices:
        shares = {
            joint.velocity / joint.velocity_everywhere: joint
            for joint in device.joints
            if joint.velocity and joint.velocity_everywhere
        }
        most = max(shares, default=0.0)
        if most > _ROUNDING:
            joint = shares[most]
            path = (*device.path, "limits", "velocity")
            message = (
                f"`{joint.name}` must have at most {joint.velocity_everywhere:g} rad/s, which holds in every position,"
            )
            message += f" got {joint.velocity:.3g} rad/s"
            share = device.limits.limit_shares.velocity
            advice = f"write at most {share / most * 100:.0f} %"
            yield found(graph, path, message, advice, described(graph, [joint.name]))


@rule(Severity.WARNING)
def unscaled_trajectory(graph: CellGraph) -> Findings:
    """Yield trajectory controllers on a scaling device that do not read its factor."""
    scaling = {device.name: device for device in graph.cell.devices if device.control.speed_scaling is not None}
    for controller in graph.cell.controllers:
        if controller.behavior is not Behavior.JOINT_TRAJECTORY or controller.device not in scaling:
            continue
        if not controller.parameters.get("speed_scaling.state_interface"):
            message = f"`{controller.device}` scales its speed, but `{controller.name}` does not follow"
            own = scaling[controller.device].control.controller_kinds
            kinds = [kind for kind, distros in own.items() if "trajectory" in kind and graph.cell.distro in distros]
            advice = f"use `type: {kinds[0]}`" if kinds else "use a controller that reads the scaling factor"
            yield found(graph, (*controller.path, "type"), message, advice)
