"""Rules on flanges, tool frames and tips."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.motion import CartesianGoal, PlanningGroup
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.transforms import Pose, Vector3

_APART_M = 1e-3
_ALONG = 0.999  # cosine; figures of descriptions are rounded


@rule(Severity.BLOCKER)
def broken_flange_convention(graph: CellGraph) -> Findings:
    """Yield devices with both frames whose z of tool0 is not x of flange, or whose origins differ."""
    for device in graph.cell.devices:
        flange, tool = device.body.frames.get("flange"), device.body.frames.get("tool0")
        if flange is None or tool is None:
            continue
        pose = graph.frames.pose_in(tool, flange, rigid=True)
        if pose is None or not _by_convention(pose):
            message = f"`tool0` of `{device.name}` must have the origin of `flange` and its z axis along x of `flange`"
            yield found(graph, (*device.path, "model"), message)


def _by_convention(pose: Pose) -> bool:
    out = Pose((0.0, 0.0, 0.0), pose.quaternion).apply((0.0, 0.0, 1.0))
    return math.hypot(*pose.position) < _APART_M and out[0] > _ALONG


@rule(Severity.ERROR, assumes=("frame-cycle",))
def tcp_off_the_tool(graph: CellGraph) -> Findings:
    """Yield TCPs that no fixed transform places in the tool frame of their arm."""
    for device in graph.cell.devices:
        if device.robot.tcp is None:
            continue
        path = (*device.path, "tcp")
        if device.body.tool_frame is None:
            yield found(graph, path, f"`{device.name}` has no frame where tools mount")
            continue
        chain = [frame.name for frame in graph.frames.chain(device.robot.tcp)]
        tool = device.body.tool_frame in chain
        between = graph.frames.chain(device.robot.tcp)[: chain.index(device.body.tool_frame)] if tool else ()
        if not tool or any(frame.moving or frame.transform_to_parent is None for frame in between):
            message = f"the TCP of `{device.name}` must be attached to `{device.body.tool_frame}` by fixed transforms"
            yield found(graph, path, f"{message}, got `{device.robot.tcp}`")


_SAME_M = 5e-3
"""Nearer than this a TCP and a tip are one point that was measured twice."""


@rule(Severity.WARNING, assumes=("frame-cycle", "tcp-off-the-tool", "tip-off-the-tool-chain"))
def tcp_beside_the_tips(graph: CellGraph) -> Findings:
    """Yield TCPs of robot controllers that are at no tip of the planning groups of their arm."""
    for device in graph.cell.devices:
        tool, tcp = device.body.tool_frame, device.robot.tcp
        place = None if tool is None or tcp is None else graph.frames.pose_in(tcp, tool, rigid=True)
        groups = graph.once(_groups_beyond).get(tool or "", ())
        if place is None or tool is None or not groups:
            continue
        tips = [graph.frames.pose_in(group.tip_frame, tool, rigid=True) for group in groups]
        ways = [math.dist(tip.position, place.position) for tip in tips if tip is not None]
        if len(ways) == len(groups) and min(ways) > _SAME_M:
            nearest = groups[ways.index(min(ways))]
            message = f"the TCP of `{device.name}` must be at the tip of a group, got `{tcp}`, {min(ways) * 1e3:.0f} mm"
            related: tuple[Related, ...] = (Related("the tip of the group", graph.cell.locate(*nearest.path, "tip")),)
            related += enters(graph, "it is here", *(frame.path for frame in graph.frames.chain(nearest.tip_frame)))
            message += f" from `{nearest.tip_frame}` of `{nearest.name}`"
            yield found(graph, (*device.path, "tcp"), message, related=related)


def _groups_beyond(graph: CellGraph) -> Mapping[str, Sequence[PlanningGroup]]:
    """Return the groups whose tip each frame carries."""
    groups: dict[str, list[PlanningGroup]] = {}
    for group in graph.cell.groups:
        for frame in graph.frames.chain(group.tip_frame):
            groups.setdefault(frame.name, []).append(group)
    return groups


def _arms(graph: CellGraph) -> Mapping[str, Device]:
    """Return the device with a tool frame of which each link is."""
    return {
        link.name: device
        for device in graph.cell.devices
        if device.body.tool_frame
        for link in device.body.description.links
    }


@rule(Severity.ERROR)
def tip_off_the_tool_chain(graph: CellGraph) -> Findings:
    """Yield groups of an arm with a tip that does not come after its tool frame."""
    arms = graph.once(_arms)
    for group in graph.cell.groups:
        arm = arms.get(group.base_link)
        if arm is None or arm.body.tool_frame is None:
            continue
        chain = graph.frames.chain(group.tip_frame)
        if arm.body.tool_frame not in (frame.name for frame in chain):
            message = f"tip `{group.tip_frame}` of group `{group.name}` is not attached to `{arm.body.tool_frame}`"
            mounts = [frame for frame in chain if frame.kind is FrameKind.MOUNT and frame.device != arm.name]
            related = tuple(Related(f"`{mount.device}` is mounted on `{mount.parent}`", mount.span) for mount in mounts)
            yield found(graph, (*group.path, "tip"), message, related=related)


_SHORTEST_M = 0.05
"""A shorter tool tells nothing."""
_NEAREST = 0.5
_BEYOND_M = 0.1


@rule(Severity.WARNING, assumes=("frame-cycle", "implausible-distance", "tip-off-the-tool-chain"))
def tip_within_tool(graph: CellGraph) -> Findings:
    """Yield tips less than halfway to the fingers of the carried gripper, or far beyond them.

    A link of the arm may well be a tip, where its goals keep the distance themselves.
    """
    for group in graph.cell.groups:
        tip = graph.frames.get(group.tip_frame)
        arm = graph.once(_arms).get(group.base_link)
        if tip is None or arm is None or arm.body.tool_frame is None:
            continue
        pose = graph.frames.pose_in(tip.name, arm.body.tool_frame)
        end = _end(graph, arm)
        if pose is None or end is None or (reach_m := math.hypot(*end)) < _SHORTEST_M:
            continue
        along_m = sum(a * b for a, b in zip(pose.position, end, strict=True)) / reach_m
        if not _NEAREST * reach_m <= along_m <= reach_m + _BEYOND_M:
            message = f"tip `{tip.name}` must lie near the end of the tool, {reach_m * 1e3:.0f} mm or more from"
            message += f" `{arm.body.tool_frame}`, got {along_m * 1e3:.3g} mm towards it"
            if tip.kind is FrameKind.FIXED:
                yield found(graph, tip.path, message, related=(Related("the group", group.span),))
            elif tip.name in _links(arm) and (near := _nearest(graph, group.name, _NEAREST * reach_m)) is not None:
                related = (Related(f"goal `{near.name}` keeps no distance", near.span),)
                yield found(graph, (*group.path, "tip"), message, related=related)


def _nearest(graph: CellGraph, group: str, within_m: float) -> CartesianGoal | None:
    """Return the first goal of a group that brings its tip nearer to the goal's frame than a distance."""
    goals = (goal for goal in graph.cell.goals if goal.group == group)
    return next((goal for goal in goals if math.hypot(*goal.transform_tip_to_frame.position) < within_m), None)


def _links(device: Device) -> set[str]:
    return {link.name for link in device.body.description.links}


def _end(graph: CellGraph, arm: Device) -> Vector3 | None:
    """Return the origin of the farthest link of the only gripper that an arm carries, in its tool frame, m."""
    grippers = [tool for name in arm.mount.carries if (tool := graph.cell.device(name)).kind == "gripper"]
    if len(grippers) != 1:
        return None
    poses = [graph.frames.pose_in(link.name, arm.body.tool_frame or "") for link in grippers[0].body.description.links]
    places = [pose.position for pose in poses if pose is not None]
    return max(places, key=lambda place: math.hypot(*place), default=None)
