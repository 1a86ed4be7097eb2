"""What the planner is asked about a cell: everything an answer depends on, and nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.motion import CartesianGoal, PlanningGroup
from cellc.compiler.formats.urdf.robot import manager_description, start_positions
from cellc.compiler.formats.xml_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.frame_tree import FrameTree
from cellc.contract.transforms import Pose, Vector3, climb

Positions = tuple[tuple[str, float], ...]
"""Joint names with rad or m."""


@dataclass(frozen=True, slots=True)
class GroupQuestion:
    """A group with the limits of its joints; infinite where the cell has none."""

    name: str
    joints: tuple[str, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    base_link: str
    tip_link: str


@dataclass(frozen=True, slots=True)
class PoseQuestion:
    """A named pose of all groups that it places."""

    name: str
    positions: Positions


@dataclass(frozen=True, slots=True)
class GoalQuestion:
    """A goal: wanted poses of the group's tip link in the world, and before the straight approach if there is one."""

    name: str
    group: str
    target: Pose
    before: Pose | None


@dataclass(frozen=True, slots=True)
class ViewQuestion:
    """An object that a step detects: its pose in the world, the optical frame, and the pose or goal taken before."""

    name: str
    camera_frame: str
    posture: str
    place: Pose


@dataclass(frozen=True, slots=True)
class CarriedQuestion:
    """What an arm carries besides the links that the description has of it: kg, and its center in a link, m."""

    link: str
    mass_kg: float
    center: Vector3


@dataclass(frozen=True, slots=True)
class AreaQuestion:
    """A volume that arms share: the link that it is fixed to, the pose of its center in it, edge lengths in m."""

    name: str
    link: str
    pose: Pose
    size: Vector3


@dataclass(frozen=True, slots=True)
class MotionQuestion:
    """The whole question; its text is what an answer is kept under. ``held`` are the joints with a limit of effort."""

    urdf: str
    start: Positions
    groups: tuple[GroupQuestion, ...]
    poses: tuple[PoseQuestion, ...]
    goals: tuple[GoalQuestion, ...]
    views: tuple[ViewQuestion, ...] = ()
    allowed: tuple[tuple[str, str], ...] = ()
    carried: tuple[CarriedQuestion, ...] = ()
    held: tuple[str, ...] = ()
    areas: tuple[AreaQuestion, ...] = ()


def shapes_and_joints(cell: Cell) -> str:
    """Return the robot description of a cell without hardware: what its geometry depends on."""
    return render(manager_description(cell, "mock", ()), "")


def motion_question(graph: CellGraph) -> MotionQuestion:
    """Ask for every named pose and every goal whose place is known before the cell runs."""
    cell = graph.cell
    tips = {group.name: _tip(graph.frames, group.tip_frame) for group in cell.groups}
    joints = {joint.name: joint for device in cell.devices for joint in device.joints}
    return MotionQuestion(
        urdf=shapes_and_joints(cell),
        start=tuple(sorted(start_positions(cell).items())),
        groups=tuple(_group(group, joints, tips[group.name][0]) for group in cell.groups),
        poses=_poses(cell),
        goals=tuple(
            question
            for goal in cell.goals
            if goal.group in tips
            for question in _goal(graph.frames, goal, tips[goal.group][1])
        ),
        views=tuple(_views(graph)),
        allowed=tuple(pair for device in cell.devices for pair in device.body.allowed_collisions),
        carried=tuple(_carried(cell)),
        held=tuple(joint.name for device in cell.devices for joint in device.joints if joint.effort),
        areas=tuple(_areas(graph)),
    )


def _areas(graph: CellGraph) -> Iterator[AreaQuestion]:
    for area in graph.cell.areas:
        link, pose = _tip(graph.frames, area.parent)
        yield AreaQuestion(area.name, link, pose @ area.transform_to_parent, area.size)


def _carried(cell: Cell) -> Iterator[CarriedQuestion]:
    """Yield what the payload of each arm has beyond the masses of its tools, where the payload has its center."""
    for device in cell.devices:
        if device.robot.payload is None or device.body.tool_frame is None:
            continue
        rest_kg = device.robot.payload.mass_kg - cell.carried_mass_kg(device)
        if rest_kg > 0.0:
            yield CarriedQuestion(device.body.tool_frame, rest_kg, device.robot.payload.center_of_mass)


def _views(graph: CellGraph) -> Iterator[ViewQuestion]:
    """Yield each object that is detected in the frame of a camera, with where the arm is then."""
    cell = graph.cell
    optical = {device.body.frames[name] for device in cell.devices for name in device.body.optical_frames}
    seen: set[tuple[str, str]] = set()
    for rehearsal in cell.rehearsals:
        posture = ""
        for step in rehearsal.steps:
            posture = step.name if step.kind == "move" else posture
            frame = graph.frames.get(step.name) if step.kind == "detect" else None
            place = None if frame is None else graph.frames.in_world(frame.name)
            if frame is not None and place is not None and frame.parent in optical:
                if (frame.name, posture) not in seen:
                    yield ViewQuestion(frame.name, frame.parent, posture, place)
                seen.add((frame.name, posture))


def _group(group: PlanningGroup, joints: Mapping[str, DeviceJoint], tip_link: str) -> GroupQuestion:
    limits = [_range(joints[name]) for name in group.joints if name in joints]
    lower, upper = tuple(low for low, _ in limits), tuple(high for _, high in limits)
    return GroupQuestion(group.name, group.joints, lower, upper, group.base_link, tip_link)


def _range(joint: DeviceJoint) -> tuple[float, float]:
    lower = -math.inf if joint.lower is None or joint.type == "continuous" else joint.lower
    upper = math.inf if joint.upper is None or joint.type == "continuous" else joint.upper
    return lower, upper


def _poses(cell: Cell) -> tuple[PoseQuestion, ...]:
    placed: dict[str, dict[str, float]] = {}
    for pose in cell.poses:
        placed.setdefault(pose.name, {}).update(zip(pose.joints, pose.positions, strict=False))
    return tuple(PoseQuestion(name, tuple(sorted(positions.items()))) for name, positions in placed.items())


def _goal(frames: FrameTree, goal: CartesianGoal, transform_tip_to_link: Pose) -> tuple[GoalQuestion, ...]:
    """Return the question of one goal; empty where its frame moves or has no known pose."""
    place = frames.in_world(goal.frame)
    if place is None:
        return ()
    tip = place @ goal.transform_tip_to_frame
    return (
        GoalQuestion(
            goal.name,
            goal.group,
            tip @ transform_tip_to_link.inverse(),
            None if goal.approach is None else _before(tip, goal.approach) @ transform_tip_to_link.inverse(),
        ),
    )


def _before(tip: Pose, approach: Vector3) -> Pose:
    return tip @ Pose(approach, (0.0, 0.0, 0.0, 1.0))


def _tip(frames: FrameTree, name: str) -> tuple[str, Pose]:
    """Return the link of a device that carries a frame, and the pose of the frame in it."""

    def edge(child: str) -> tuple[str, Pose] | None:
        frame = frames.get(child)
        if frame is None or frame.kind is not FrameKind.FIXED or frame.transform_to_parent is None:
            return None
        return frame.parent, frame.transform_to_parent

    return climb(name, edge)
