"""Where the links of a description stand at given joint positions: forward kinematics without a library.

Source: http://wiki.ros.org/urdf/XML/joint (2023-11-08): the child frame is the joint frame, turned about or moved along
the axis, which is given in the joint frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from cellc.contract.transforms import Pose, Vector3, identity
from cellc.robot.description.model import Description, Joint


def posture(description: Description, positions: Mapping[str, float]) -> dict[str, Pose]:
    """Return the pose of each link in the root link.

    Args:
        description: a tree; links that no chain of joints joins to its first root are left out.
        positions: rad or m by joint; a joint that is not named is at zero, one that mimics follows.
    """
    children: dict[str, list[Joint]] = {}
    for joint in description.joints:
        children.setdefault(joint.parent, []).append(joint)
    poses = {root: identity() for root in description.roots()[:1]}
    waiting = list(poses)
    while waiting:
        parent = waiting.pop(0)
        for joint in children.get(parent, ()):
            if joint.child not in poses:
                poses[joint.child] = poses[parent] @ joint.pose @ moved(joint, _position(joint, description, positions))
                waiting.append(joint.child)
    return poses


def farthest(description: Description, tip: str, start: Mapping[str, float]) -> float:
    """Return how far ``tip`` gets from the axis of the first joint that moves it, in meters: what an arm can reach.

    Each joint in turn goes to its best position, first in coarse steps and then in ever finer ones, until nothing is
    gained. That is a local optimum, so that an arm may reach a little farther.
    """
    chain = _chain(description, tip)
    driving = [joint for joint in chain if joint.movable and joint.mimic is None]
    positions = dict(start)
    best = _distance(chain, positions)
    for step in _STEPS:
        for joint in driving:
            for position in _around(joint, positions.get(joint.name, 0.0), step):
                tried = positions | {joint.name: position}
                distance = _distance(chain, tried)
                if distance > best:
                    best, positions = distance, tried
    return best


_COARSE = 24
_STEPS = (*(1.0 / _COARSE,) * 4, *(0.5**halved / _COARSE for halved in range(1, 16)))
"""Shares of a joint's range: four rounds over all of it, and then around the best."""


def _around(joint: Joint, position: float, step: float) -> Iterable[float]:
    lower, upper = _range(joint)
    width = (upper - lower) * step
    if step == _STEPS[0]:
        return (lower + width * number for number in range(_COARSE + 1))
    return (min(max(position + width * number, lower), upper) for number in (-1, 1))


def _range(joint: Joint) -> tuple[float, float]:
    limit = joint.limit
    if limit is None or limit.lower is None or limit.upper is None or joint.type == "continuous":
        return -math.pi, math.pi
    return limit.lower, limit.upper


def _chain(description: Description, tip: str) -> tuple[Joint, ...]:
    """Return the joints from the first that moves ``tip`` down to it."""
    above = {joint.child: joint for joint in description.joints}
    chain: list[Joint] = []
    link = tip
    while link in above and len(chain) <= len(above):
        chain.insert(0, above[link])
        link = above[link].parent
    moving = next((number for number, joint in enumerate(chain) if joint.movable), len(chain))
    return tuple(chain[moving:])


def _distance(chain: Iterable[Joint], positions: Mapping[str, float]) -> float:
    pose = identity()
    axis: Vector3 | None = None
    for joint in chain:
        step = moved(joint, positions.get(joint.name, 0.0))
        # The frame of the first joint is where the distance is measured from.
        pose = pose @ step if axis is None else pose @ joint.pose @ step
        axis = axis or joint.axis
    along = 0.0 if axis is None else sum(a * b for a, b in zip(_unit(axis), pose.position, strict=True))
    return math.sqrt(max(0.0, sum(value * value for value in pose.position) - along * along))


def _position(joint: Joint, description: Description, positions: Mapping[str, float]) -> float:
    if joint.mimic is None:
        return positions.get(joint.name, 0.0)
    leader = description.joint(joint.mimic.joint)
    if leader is None or leader.mimic is not None:
        return joint.mimic.offset  # a chain of mimics is refused by a rule
    return joint.mimic.multiplier * positions.get(leader.name, 0.0) + joint.mimic.offset


def moved(joint: Joint, position: float) -> Pose:
    """Return the child frame of a joint in its joint frame, which it is at zero; rad or m."""
    x, y, z = _unit(joint.axis)
    if joint.slides:
        return Pose((x * position, y * position, z * position), (0.0, 0.0, 0.0, 1.0))
    if not joint.movable:
        return identity()
    sine = math.sin(position / 2.0)
    return Pose((0.0, 0.0, 0.0), (x * sine, y * sine, z * sine, math.cos(position / 2.0)))


def _unit(axis: Vector3) -> Vector3:
    length = math.sqrt(sum(value * value for value in axis)) or 1.0
    return (axis[0] / length, axis[1] / length, axis[2] / length)
