"""Pairs of links whose collision is not worth checking, as a MoveIt setup would write them to an SRDF."""

from __future__ import annotations

import math

import numpy as np

from cellc.kinematics.limits import Array
from cellc.kinematics.model import RobotModel
from cellc.kinematics.scene import CollisionScene, LinkPair


def always_colliding_or_adjacent(model: RobotModel, *, samples: int, rng_seed: int) -> tuple[LinkPair, ...]:
    """Return the pairs of neighbours, and the pairs in contact at every one of the sampled configurations, sorted.

    Two links are neighbours where at most one movable joint joins them and no other link with a collision shape lies
    between them: the joint itself makes their shapes overlap.

    Args:
        samples: number of configurations, drawn uniformly within the URDF's position limits.
        rng_seed: seed of the draw.
    """
    adjacent = _adjacent(model)
    scene = CollisionScene(model, disabled_collisions=adjacent)
    generator = np.random.default_rng(rng_seed)
    always = set(scene.checked_pairs()) if samples > 0 else set()
    for _ in range(samples):
        if not always:
            break
        always.intersection_update(scene.contacts(_draw(model, generator)))
    return tuple(sorted(always.union(adjacent)))


def _adjacent(model: RobotModel) -> tuple[LinkPair, ...]:
    frames = model.kinematics.frames
    shaped = {shape.parentFrame for shape in model.geometry.geometryObjects}
    found: set[LinkPair] = set()
    for frame in shaped:
        joint = frames[frame].parentJoint
        ancestor = _shaped_ancestor(model, frame, shaped)
        if ancestor is None:
            continue
        other = frames[ancestor].parentJoint
        if other != joint and model.kinematics.parents[joint] == other:
            first, second = sorted((str(frames[frame].name), str(frames[ancestor].name)))
            found.add((first, second))
    return tuple(sorted(found))


def _shaped_ancestor(model: RobotModel, frame: int, shaped: set[int]) -> int | None:
    frames = model.kinematics.frames
    at = frames[frame].parentFrame
    while at != 0:
        if at in shaped:
            return int(at)
        at = frames[at].parentFrame
    return None


def _draw(model: RobotModel, generator: np.random.Generator) -> Array:
    positions: dict[str, float] = {}
    for joint in model.joints:
        index = model.joint_of(joint)
        at = model.kinematics.idx_qs[index]
        lower, upper = -math.pi, math.pi
        if model.kinematics.nqs[index] == 1:
            lower = float(model.kinematics.lowerPositionLimit[at])
            upper = float(model.kinematics.upperPositionLimit[at])
        positions[joint] = float(generator.uniform(lower, upper))
    return model.configuration(positions)
