"""Configurations of the whole robot, drawn within its position limits by a told seed."""

from __future__ import annotations

import math
import random

import numpy as np
import pinocchio

from cellc.planning.limits import Array
from cellc.planning.model import RobotModel


def draw_configurations(model: RobotModel, *, samples: int, rng_seed: int) -> Array:
    """Draw configurations uniformly within the URDF's position limits; mimic joints follow.

    A continuous joint is drawn within one turn. Python's own generator is used: its sequence of ``random()`` is the
    same on every version and platform.

    Returns:
        An array of shape (samples, nq), each row a configuration of pinocchio.
    """
    generator = random.Random(rng_seed)
    rows: Array = np.tile(np.asarray(pinocchio.neutral(model.kinematics), dtype=np.float64), (samples, 1))
    drawn: dict[str, Array] = {}
    for joint in model.joints:
        lower, upper = _range(model, joint)
        shares = np.array([generator.random() for _ in range(samples)])
        drawn[joint] = lower + shares * (upper - lower)
        _set(model, rows, joint, drawn[joint])
    for mimic in model.mimics:
        _set(model, rows, mimic.joint, mimic.multiplier * drawn[mimic.leader] + mimic.offset)
    return rows


def _range(model: RobotModel, joint: str) -> tuple[float, float]:
    index = model.joint_of(joint)
    if model.kinematics.nqs[index] == 1:
        at = model.kinematics.idx_qs[index]
        lower, upper = float(model.kinematics.lowerPositionLimit[at]), float(model.kinematics.upperPositionLimit[at])
        if math.isfinite(lower) and math.isfinite(upper):
            return lower, upper
    return -math.pi, math.pi


def _set(model: RobotModel, rows: Array, joint: str, positions: Array) -> None:
    index = model.kinematics.getJointId(joint)
    at = model.kinematics.idx_qs[index]
    if model.kinematics.nqs[index] == 2:  # a continuous joint is cosine and sine in pinocchio
        rows[:, at], rows[:, at + 1] = np.cos(positions), np.sin(positions)
    else:
        rows[:, at] = positions
