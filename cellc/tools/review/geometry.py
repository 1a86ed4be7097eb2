"""Where frames, tips and goals stand by the description and the contract of a package: forward kinematics."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from cellc.contract.transforms import Pose, apart, climb
from cellc.robot.description.model import Joint
from cellc.tools.review.facts import Facts

_GOAL = "place in the root frame"
_NOTICED_M, _NOTICED_RAD = 1e-6, 1e-6


@dataclass(frozen=True, slots=True)
class Moved:
    """A tip in a named pose, or a goal, that moved in the root frame without an edit of its own keys."""

    subject: str
    quantity: str
    before: Pose
    after: Pose


def moved_places(before: Facts, after: Facts) -> Iterator[Moved]:
    """Yield tips in named poses and goals that both sides have and that stand elsewhere after the change."""
    for of, place in (("tip", tips), (_GOAL, goals)):
        was, now = place(before), place(after)
        for name in was:
            if name in now and not (of == _GOAL and _same_frame(name, before, after)):
                meters, radians = apart(was[name], now[name])
                if meters > _NOTICED_M or radians > _NOTICED_RAD:
                    yield Moved(name, of, was[name], now[name])


def _same_frame(goal: str, before: Facts, after: Facts) -> bool:
    """Tell whether a goal moved in its frame alone, which its own pose tells."""
    was, now = (place(side, side.contract.goals[goal].frame, {}) for side in (before, after))
    return was is not None and now is not None and max(apart(was, now)) <= _NOTICED_M


def tips(facts: Facts) -> dict[str, Pose]:
    """Return where the tip of each group is in each named pose, in the root frame."""
    poses = {}
    for name, targets in facts.contract.poses.items():
        positions = _positions(facts, name)
        for target in targets:
            group = facts.contract.groups.get(target.group)
            pose = None if group is None else place(facts, group.tip_frame, positions)
            if pose is not None:
                poses[f"{target.group} in {name}"] = pose
    return poses


def goals(facts: Facts) -> dict[str, Pose]:
    """Return where each goal puts its tip in the root frame, with joints at zero and dynamic frames as on the mock."""
    poses = {}
    for name, goal in facts.contract.goals.items():
        frame = place(facts, goal.frame, {})
        if frame is not None:
            poses[name] = frame @ goal.pose.pose
    return poses


def _positions(facts: Facts, name: str) -> Mapping[str, float]:
    positions: dict[str, float] = {}
    for target in facts.contract.poses[name]:
        group = facts.contract.groups.get(target.group)
        if group is not None and len(group.joints) == len(target.positions):
            positions.update(zip(group.joints, target.positions, strict=True))
    return positions


def place(facts: Facts, frame: str, positions: Mapping[str, float]) -> Pose | None:
    """Return the pose of a frame in the root of the tree; None where no chain leads there.

    Args:
        positions: joint positions, rad or m; a joint that is not among them is at zero.
    """

    def edge(child: str) -> tuple[str, Pose] | None:
        joint, stated = facts.joints.get(child), facts.contract.frames.get(child)
        if joint is not None:
            return joint.parent, _carried(joint, positions)
        if stated is not None and stated.pose is not None:
            return stated.parent, stated.pose.pose
        if stated is not None and stated.simulated_pose is not None and stated.simulated_parent is not None:
            return stated.simulated_parent, stated.simulated_pose.pose
        return None

    top, pose = climb(frame, edge, (facts.contract.root_frame,))
    return pose if top == facts.contract.root_frame else None


def _carried(joint: Joint, positions: Mapping[str, float]) -> Pose:
    position = positions.get(joint.name, 0.0)
    length = math.hypot(*joint.axis)
    if not position or not joint.movable or not length:
        return joint.pose
    x, y, z = (value / length for value in joint.axis)
    if joint.type == "prismatic":
        return joint.pose @ Pose((x * position, y * position, z * position), (0.0, 0.0, 0.0, 1.0))
    sine = math.sin(position / 2.0)
    return joint.pose @ Pose((0.0, 0.0, 0.0), (x * sine, y * sine, z * sine, math.cos(position / 2.0)))
