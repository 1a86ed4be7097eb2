"""Pairs of links that no joint position brings together, by the triangle inequality along their chains.

A proof, unlike sampling, and cheap: robots that stand apart in one cell need no sample.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellc.planning.limits import Array
from cellc.planning.model import RobotModel
from cellc.planning.shapes import LinkPair, shape_links


@dataclass(frozen=True, slots=True, eq=False)
class _Ball:
    """What holds a shape in the frame of a joint, whatever the joints below it do; metres."""

    joint: int
    centre: Array
    radius: float


def beyond_reach(model: RobotModel, *, margin_m: float) -> set[LinkPair]:
    """Return the pairs of links on different moving bodies that always stay farther apart than a margin in metres."""
    names = shape_links(model)
    balls = [{ball.joint: ball for ball in _balls(model, shape)} for shape in model.geometry.geometryObjects]
    near: set[LinkPair] = set()
    far: set[LinkPair] = set()
    for second, name in enumerate(names):
        for first, other in enumerate(names[:second]):
            pair = (min(name, other), max(name, other))
            (far if _apart(balls[first], balls[second], margin_m) else near).add(pair)
    return far - near


def _apart(first: dict[int, _Ball], second: dict[int, _Ball], margin_m: float) -> bool:
    joint = next(joint for joint in first if joint in second)  # the nearest body that carries both
    distance = math.dist(first[joint].centre, second[joint].centre)
    return distance > first[joint].radius + second[joint].radius + margin_m


def _balls(model: RobotModel, shape: Any) -> Iterator[_Ball]:
    """Yield the ball of a shape in the frame of its joint, and of each joint above it up to the world."""
    geometry, placement, joint = shape.geometry, shape.placement, int(shape.parentJoint)
    geometry.computeLocalAABB()
    centre, radius = np.asarray(placement.act(geometry.aabb_center)), float(geometry.aabb_radius)
    yield _Ball(joint, centre, radius)
    while joint != 0:
        # Turned by this joint, the ball sweeps a ball round the joint's origin.
        radius += float(np.linalg.norm(centre)) + _travel(model, joint)
        centre = np.asarray(model.kinematics.jointPlacements[joint].translation)
        joint = int(model.kinematics.parents[joint])
        yield _Ball(joint, centre, radius)


def _travel(model: RobotModel, joint: int) -> float:
    """Return how far the origin of a joint leaves its place, in metres."""
    kind, name = model.kinematics.joints[joint].shortname(), str(model.kinematics.names[joint])
    if "JointModelR" in kind:
        return 0.0
    if "JointModelP" in kind and name in model.joints:  # a follower goes where its leader sends it, limits or not
        at = model.kinematics.idx_qs[joint]
        lower, upper = model.kinematics.lowerPositionLimit[at], model.kinematics.upperPositionLimit[at]
        return float(max(abs(lower), abs(upper)))
    return math.inf
