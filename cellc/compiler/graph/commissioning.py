"""Caps of planned motion: what each stage of commissioning leaves each joint, and how fast a tip can then be."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.cell.motion import PlanningGroup
from cellc.compiler.cell.site import Commissioning
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3, climb, identity
from cellc.robot.description.model import Joint
from cellc.robot.description.posture import moved

LINEAR_M_S, LINEAR_M_S2, TURNING_RAD_S = 0.25, 0.5, 0.5
"""Limits of linear motion without caps. 0.25 m/s is the reduced speed of ISO 10218-1; the others are own choices that
reach it within half a second."""


@dataclass(frozen=True, slots=True)
class Capped:
    """What a stage leaves a joint, rad or m, per second and per second squared; None where it has no limit."""

    velocity: float | None
    acceleration: float | None


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of commissioning.

    Args:
        percent: as files and launch arguments name it, such as ``10``.
        velocity, acceleration: shares of what is there without caps.
        joints: what it leaves each joint that moves on its own, by name.
        tips: how fast the tip of each group can be on any path at most, m/s.
        tip_speed: what no path may give a tip in the last stage, m/s; None where a share is stated.
    """

    percent: str
    velocity: float
    acceleration: float
    joints: Mapping[str, Capped]
    tips: Mapping[str, float]
    tip_speed: float | None

    def of_straight(self, speed: float) -> float:
        """Return the share that is left of a limit of linear motion, in m/s."""
        within = 1.0 if self.tip_speed is None or speed <= 0.0 else min(1.0, self.tip_speed / speed)
        return self.velocity * within


def stages(graph: CellGraph) -> tuple[Stage, ...]:
    """Return the stages of a cell in order; none where the spec states no caps."""
    caps = graph.cell.bringup.caps
    return () if caps is None else tuple(_stage(graph, caps, share) for share in caps.stages)


def percent(share: float) -> str:
    """Return a share as files and launch arguments name it."""
    return f"{round(share * 100.0, 6):g}"


def _stage(graph: CellGraph, caps: Commissioning, share: float) -> Stage:
    bounds = graph.once(tip_bounds)
    shares = {group.name: share * _share(caps, bounds[group.name]) for group in graph.cell.groups}
    of_joint: dict[str, float] = {}
    for group in graph.cell.groups:
        for name in group.joints:
            of_joint[name] = min(shares[group.name], of_joint.get(name, math.inf))
    velocity, acceleration = share * caps.velocity, share * caps.acceleration
    return Stage(
        percent=percent(share),
        velocity=velocity,
        acceleration=acceleration,
        joints={
            joint.name: Capped(
                _of(of_joint.get(joint.name, velocity), joint.velocity), _of(acceleration, joint.acceleration)
            )
            for joint in own_joints(graph)
        },
        tips={name: of * bounds[name] for name, of in shares.items()},
        tip_speed=caps.tip_speed,
    )


def own_joints(graph: CellGraph) -> Iterator[DeviceJoint]:
    """Yield every joint that moves on its own."""
    return (joint for device in graph.cell.devices for joint in device.joints if joint.mimics is None)


def _share(caps: Commissioning, bound: float) -> float:
    """Return the share of its joints' velocities that a group is left, of which the tip is ``bound`` at most at all."""
    return caps.velocity if caps.tip_speed is None or bound <= 0.0 else min(1.0, caps.tip_speed / bound)


def _of(share: float, limit: float | None) -> float | None:
    return None if limit is None else share * limit


def tip_bounds(graph: CellGraph) -> Mapping[str, float]:
    """Return how fast the tip of each group is at most with every joint at its limit, in m/s.

    Each joint turns the tip about its axis at no more than its velocity times the length of what is between the two,
    straightened; the sum over the joints is exceeded in no posture.
    """
    velocities = {joint.name: joint.velocity or 0.0 for joint in own_joints(graph)}
    return {
        group.name: sum(velocities.get(joint, 0.0) * arm for joint, arm in chain_of(graph, group).arms.items())
        for group in graph.cell.groups
    }


@dataclass(frozen=True, slots=True)
class Chain:
    """What is between the tip of a group and its base, straightened.

    Args:
        arms: how far the tip is at most from the axis of each joint of the group, m; 1 of one that slides.
        length: how far the tip is at most from the base, m.
    """

    arms: Mapping[str, float]
    length: float


def chain_of(graph: CellGraph, group: PlanningGroup) -> Chain:
    """Return the chain of a group; joints outside of the group may be anywhere in it."""
    arms: dict[str, float] = {}
    length, rigid, tip = 0.0, True, identity()
    for frame in graph.frames.chain(group.tip_frame):
        if frame.name == group.base_link or frame.transform_to_parent is None:
            break
        joint = graph.once(_joints_above).get(frame.name)
        if joint is not None and joint.name in group.joints:
            arms[joint.name] = 1.0 if joint.slides else _from_axis(joint.axis, tip) if rigid else length
        if joint is not None and joint.movable:
            length, rigid = length + (_travel(joint) if joint.slides else 0.0), False
        length += math.hypot(*frame.transform_to_parent.position)
        tip = frame.transform_to_parent @ tip
    return Chain(arms, length)


def tip_in_base(graph: CellGraph, group: PlanningGroup, positions: Mapping[str, float]) -> Pose | None:
    """Return the pose of the tip of a group in its base, joints that are not named at zero; None where none is fixed.

    Args:
        positions: rad or m by joint.
    """

    def edge(child: str) -> tuple[str, Pose] | None:
        frame = graph.frames.get(child)
        if frame is None or not frame.parent or frame.transform_to_parent is None:
            return None
        joint = graph.once(_joints_above).get(child)
        step = identity() if joint is None else moved(joint, positions.get(joint.name, 0.0))
        return frame.parent, frame.transform_to_parent @ step

    top, pose = climb(group.tip_frame, edge, (group.base_link,))
    return pose if top == group.base_link else None


def _joints_above(graph: CellGraph) -> Mapping[str, Joint]:
    """Return the joint above each link."""
    return {joint.child: joint for device in graph.cell.devices for joint in device.body.description.joints}


def _travel(joint: Joint) -> float:
    limit = joint.limit
    return 0.0 if limit is None else max(abs(limit.lower or 0.0), abs(limit.upper or 0.0))


def _from_axis(axis: Vector3, tip: Pose) -> float:
    """Return how far the tip is from an axis through the origin, exact where nothing moves between the two."""
    whole = math.hypot(*axis) or 1.0
    along = sum(a * b for a, b in zip(axis, tip.position, strict=True)) / whole
    return math.sqrt(max(0.0, math.hypot(*tip.position) ** 2 - along**2))
