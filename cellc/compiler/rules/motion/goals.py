"""Rules on goals: where they are, what they rest on, and how long the way to them takes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

from cellc.compiler.cell.frame import WORLD, FrameKind
from cellc.compiler.cell.motion import PlanningGroup
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS, in_the_chain
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, did_you_mean, enters, found, rule
from cellc.contract.vocabulary import InterfaceKind


@rule(Severity.ERROR)
def detected_static_frame(graph: CellGraph) -> Findings:
    """Yield steps that detect a frame which is not dynamic, once where the steps are shared."""
    reported: set[YamlPath] = set()
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        frame = graph.frames.get(step.name) if step.kind == "detect" else None
        if frame is not None and frame.kind is not FrameKind.DYNAMIC and step.path not in reported:
            reported.add(step.path)
            dynamic = (f.name for f in graph.cell.frames if f.kind is FrameKind.DYNAMIC)
            message = f"`{step.name}` is static and cannot be detected"
            yield found(graph, step.path, message, did_you_mean(step.name, dynamic, "dynamic frames"))


@rule(Severity.ERROR)
def goal_moves_with_tip(graph: CellGraph) -> Findings:
    """Yield goals in a fixed frame that hangs on a link moved by the goal's own group."""
    groups = {group.name: group for group in graph.cell.groups}
    children = {joint.child: joint.name for device in graph.cell.devices for joint in device.body.description.joints}
    for goal in graph.cell.goals:
        frame = graph.frames.get(goal.frame)
        if frame is None or frame.kind is FrameKind.DYNAMIC or goal.group not in groups:
            continue
        moved = {children[edge.name] for edge in graph.frames.chain(goal.frame) if edge.name in children}
        if not moved.isdisjoint(groups[goal.group].joints):
            message = f"goal `{goal.name}` is in `{goal.frame}`, which group `{goal.group}` moves itself"
            yield found(graph, (*goal.path, "frame"), message)


@rule(Severity.ERROR, assumes=("frame-cycle",))
def goal_out_of_reach(graph: CellGraph) -> Findings:
    """Yield goals in static frames beyond the stretched length of their group."""
    groups = {group.name: group for group in graph.cell.groups}
    for goal in graph.cell.goals:
        group = groups.get(goal.group)
        target = None if group is None else graph.frames.pose_in(goal.frame, WORLD, rigid=True)
        base = None if group is None else graph.frames.pose_in(group.base_link, WORLD, rigid=True)
        if group is None or target is None or base is None:
            continue
        place = (target @ goal.transform_tip_to_frame).position
        distance = math.dist(place, base.position)
        length = _stretched(graph, group)
        if distance > length:
            message = (
                f"goal `{goal.name}` is {distance:.3g} m from `{group.base_link}`, but the chain is {length:.3g} m long"
            )
            related = in_the_chain(graph, goal.name)
            yield found(graph, (*goal.path, "frame"), message, related=related)


def _stretched(graph: CellGraph, group: PlanningGroup) -> float:
    """Return the sum of the lengths from base to tip, and of the travel of prismatic joints, in meters."""
    length = 0.0
    for frame in graph.frames.chain(group.tip_frame):
        if frame.name == group.base_link:
            break
        length += math.hypot(*frame.transform_to_parent.position) if frame.transform_to_parent else 0.0
    joints = graph.cell.joints_by_name
    own = (joints[name] for name in group.joints if name in joints)
    return length + sum(max(abs(j.lower or 0.0), abs(j.upper or 0.0)) for j in own if j.type == "prismatic")


_SHORTEST_M = 0.001
_LONGEST_M = 1.0


@rule(Severity.ERROR)
def implausible_approach(graph: CellGraph) -> Findings:
    """Yield approaches below 1 mm, and above 1 m."""
    for goal in graph.cell.goals:
        length = None if goal.approach is None else math.hypot(*goal.approach)
        if length is not None and not _SHORTEST_M <= length <= _LONGEST_M:
            message = (
                f"the approach of goal `{goal.name}` must be from {_SHORTEST_M * 1e3:g} mm to {_LONGEST_M:g} m,"
                f" got {length * 1e3:g} mm"
            )
            yield found(graph, (*goal.path, "approach"), message)


_EXECUTING = frozenset({"moveit_msgs/action/MoveGroup", "moveit_msgs/action/ExecuteTrajectory"})


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def timeout_below_motion(graph: CellGraph) -> Findings:
    """Yield actions that execute motion with less time than the longest move of a rehearsal needs at least."""
    longest = max(_moves(graph), default=None)
    for interface in graph.cell.interfaces:
        timeout_s = interface.timeout_s
        if interface.kind is not InterfaceKind.ACTION or interface.type not in _EXECUTING or interface.derived:
            continue
        if longest is not None and timeout_s is not None and timeout_s < longest[0]:
            needed_s, start, end = longest
            message = f"the timeout of `{interface.name}` must be at least {needed_s:.2g} s, which the joints need from"
            path = (*interface.path, "timeout")
            limits = enters(graph, "so fast", *((*device.path, "limits") for device in graph.cell.devices))
            related = (*limits, *in_the_chain(graph, start), *in_the_chain(graph, end))
            yield found(graph, path, f"{message} `{start}` to `{end}`, got {graph.cell.text(*path)}", related=related)


def _moves(graph: CellGraph) -> list[tuple[float, str, str]]:
    """Return the least time of each move of the rehearsals, s, with the names of its ends."""
    places = _postures(graph)
    found_ = []
    for rehearsal in graph.cell.rehearsals:
        names = [step.name for step in rehearsal.steps if step.kind == "move" and step.name in places]
        for start, end in pairwise(names):
            found_.append((_least_s(graph, places[start], places[end]), start, end))
    return found_


def _postures(graph: CellGraph) -> Mapping[str, dict[str, float]]:
    """Return the joint positions of every named pose, and of every goal that has a solution."""
    places: dict[str, dict[str, float]] = {}
    for pose in graph.cell.poses:
        places.setdefault(pose.name, {}).update(zip(pose.joints, pose.positions, strict=False))
    joints = {group.name: group.joints for group in graph.cell.groups}
    groups = {goal.name: goal.group for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.configuration:
            places[goal.name] = dict(zip(joints[groups[goal.name]], goal.configuration, strict=True))
    return places


def _least_s(graph: CellGraph, start: Mapping[str, float], end: Mapping[str, float]) -> float:
    """Return how long the slowest joint needs from rest to rest, at its full speed and acceleration."""
    slowest = 0.0
    for device in graph.cell.devices:
        for joint in device.joints:
            if joint.name not in start or joint.name not in end or not joint.velocity:
                continue
            way = abs(end[joint.name] - start[joint.name])
            slowest = max(slowest, _alone_s(way, joint.velocity, joint.acceleration))
    return slowest


def _alone_s(way: float, velocity: float, acceleration: float | None) -> float:
    """Return the time of a joint alone: it speeds up and slows down, with a stretch at full speed on a long way."""
    if not acceleration:
        return way / velocity
    ramp = velocity / acceleration
    return 2.0 * math.sqrt(way / acceleration) if way < velocity * ramp else way / velocity + ramp


@rule(Severity.ERROR)
def undetected_goal(graph: CellGraph) -> Findings:
    """Yield moves to goals in a dynamic frame before a step that detects it."""
    goals = {goal.name: goal.frame for goal in graph.cell.goals}
    dynamic = {frame.name for frame in graph.cell.frames if frame.kind is FrameKind.DYNAMIC}
    reported: set[YamlPath] = set()
    for rehearsal in graph.cell.rehearsals:
        seen: set[str] = set()
        for step in rehearsal.steps:
            frame = goals.get(step.name, "") if step.kind == "move" else ""
            if step.kind == "detect":
                seen.add(step.name)
            elif frame in dynamic and frame not in seen and step.path not in reported:
                reported.add(step.path)
                message = f"`{rehearsal.name}` moves to `{step.name}` before it detects `{frame}`"
                yield found(graph, step.path, message, f"add the step `detect: {frame}` before it")
