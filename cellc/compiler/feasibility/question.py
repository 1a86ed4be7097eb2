"""What the planner is asked about a cell: everything an answer depends on, and nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.cell.motion import CartesianGoal, PlanningGroup, Step
from cellc.compiler.formats.urdf.robot import manager_description, start_positions
from cellc.compiler.formats.xml_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.control_laws import control_laws, start_outside
from cellc.compiler.graph.frame_tree import FrameTree
from cellc.contract.control_law import ControlLaw, LinkMass
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3

Positions = tuple[tuple[str, float], ...]
"""Joint names with rad or m."""


@dataclass(frozen=True, slots=True)
class GroupQuestion:
    """A group with the limits of its joints, infinite where the cell has none, and its tip frame in the tip link."""

    name: str
    joints: tuple[str, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    base_link: str
    tip_link: str
    transform_tip_to_link: Pose


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
class LawQuestion:
    """The joints of a device behind springs."""

    device: str
    law: ControlLaw


@dataclass(frozen=True, slots=True)
class VisitQuestion:
    """A pose or goal that a rehearsal goes to, from another, and the devices that hold a part meanwhile.

    ``before`` is empty for where the cell begins, and None where no rehearsal goes there.
    """

    posture: str
    before: str | None
    holding: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AreaQuestion:
    """A volume that arms share: the link that it is fixed to, the pose of its center in it, edge lengths in m."""

    name: str
    link: str
    pose: Pose
    size: Vector3


@dataclass(frozen=True, slots=True)
class MotionQuestion:
    """The whole question; its text is what an answer is kept under.

    Attributes:
        held: joints with a limit of effort.
        start_outside: how far outside its limits a joint may be where a motion begins, rad or m.
    """

    urdf: str
    start: Positions
    groups: tuple[GroupQuestion, ...]
    poses: tuple[PoseQuestion, ...]
    goals: tuple[GoalQuestion, ...]
    views: tuple[ViewQuestion, ...] = ()
    allowed: tuple[tuple[str, str], ...] = ()
    carried: tuple[LinkMass, ...] = ()
    held: tuple[str, ...] = ()
    areas: tuple[AreaQuestion, ...] = ()
    laws: tuple[LawQuestion, ...] = ()
    visits: tuple[VisitQuestion, ...] = ()
    start_outside: float = 0.0


def shapes_and_joints(graph: CellGraph) -> str:
    """Return the robot description of a cell without hardware: what its geometry depends on, which a graph has once."""
    return render(manager_description(graph.cell, "mock", ()))


def motion_question(graph: CellGraph, whole: CellGraph | None = None) -> MotionQuestion:
    """Ask for every named pose and every goal whose place is known before the cell runs.

    Args:
        whole: the cell of which ``graph`` is a part, whose laws hold in the part too.
    """
    cell, of_whole = graph.cell, graph if whole is None else whole
    known = of_whole.once(_laws)
    laws = {device.name: known[device.name] for device in cell.devices if device.name in known}
    tips = {group.name: graph.frames.carrier(group.tip_frame) for group in cell.groups}
    joints = cell.joints_by_name
    return MotionQuestion(
        urdf=graph.once(shapes_and_joints),
        start=tuple(sorted(start_positions(cell).items())),
        groups=tuple(_group(group, joints, tips[group.name]) for group in cell.groups),
        poses=_poses(cell),
        goals=tuple(
            question
            for goal in cell.goals
            if goal.group in tips
            for question in _goal(graph.frames, goal, tips[goal.group][1])
        ),
        views=tuple(views(graph)),
        allowed=tuple(pair for device in cell.devices for pair in device.body.allowed_collisions),
        carried=tuple(_carried(cell)),
        held=tuple(joint.name for device in cell.devices for joint in device.joints if joint.effort),
        areas=tuple(_areas(graph)),
        laws=tuple(LawQuestion(name, law) for name, law in laws.items() if law.joints),
        visits=_visits(cell, [name for name, law in laws.items() if law.part]),
        start_outside=of_whole.once(_start_outside),
    )


def _laws(graph: CellGraph) -> Mapping[str, ControlLaw]:
    return control_laws(graph.cell)


def _start_outside(graph: CellGraph) -> float:
    return start_outside(graph.cell)


def _visits(cell: Cell, loadable: Sequence[str]) -> tuple[VisitQuestion, ...]:
    """Return where rehearsals go, with what is held on the way, each once; and what they leave out, with both loads."""
    known = [*(pose.name for pose in cell.poses), *(goal.name for goal in cell.goals)]
    found: dict[VisitQuestion, None] = {}
    for rehearsal in cell.rehearsals:
        before, closed = "", set[str]()
        for step in rehearsal.steps:
            if step.kind == "move" and step.name in known:
                found[VisitQuestion(step.name, before, tuple(sorted(_holding(cell, closed, loadable))))] = None
                before = step.name
            elif step.kind in ("grip", "set"):
                closed = closed | {step.name} if _closes(cell, step) else closed - {step.name}
    for name in dict.fromkeys(known):
        if not any(visit.posture == name for visit in found):
            found |= dict.fromkeys(VisitQuestion(name, None, holding) for holding in ((), tuple(sorted(loadable))))
    return tuple(found)


def _closes(cell: Cell, step: Step) -> bool:
    device = next((device for device in cell.devices if device.name == step.name), None)
    switched = None if device is None else device.switched
    return step.command == "close" or (switched is not None and step.state is not None and step.state == switched.holds)


def _holding(cell: Cell, closed: Iterable[str], loadable: Sequence[str]) -> Iterator[str]:
    """Yield the devices that hold their part by what is closed: the arm that carries it, or its own fingers."""
    carriers = {name: device.name for device in cell.devices for name in device.mount.carries}
    for name in closed:
        seen = set[str]()
        while name not in seen:
            seen.add(name)
            name = carriers.get(name, name)
        yield from (device for device in loadable if device in seen)


def _areas(graph: CellGraph) -> Iterator[AreaQuestion]:
    for area in graph.cell.areas:
        link, pose = graph.frames.carrier(area.parent)
        yield AreaQuestion(area.name, link, pose @ area.transform_to_parent, area.size)


def _carried(cell: Cell) -> Iterator[LinkMass]:
    """Yield what the payload of each arm has beyond the masses of its tools, where the payload has its center."""
    for device in cell.devices:
        if device.robot.payload is None or device.body.tool_frame is None:
            continue
        rest_kg = device.robot.payload.mass_kg - cell.carried_mass_kg(device)
        if rest_kg > 0.0:
            center = device.robot.payload.center_of_mass
            yield LinkMass(link=device.body.tool_frame, mass_kg=rest_kg, center=center)


def views(graph: CellGraph) -> Iterator[ViewQuestion]:
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


def _group(group: PlanningGroup, joints: Mapping[str, DeviceJoint], tip: tuple[str, Pose]) -> GroupQuestion:
    limits = [_range(joints[name]) for name in group.joints if name in joints]
    lower, upper = tuple(low for low, _ in limits), tuple(high for _, high in limits)
    return GroupQuestion(group.name, group.joints, lower, upper, group.base_link, *tip)


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
