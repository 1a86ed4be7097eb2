"""Levenberg-Marquardt on the pose error of the tip: one descent from one seed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pinocchio

from cellc.planning.chain import GroupChain
from cellc.planning.limits import Array, JointLimits
from cellc.planning.model import PinTransform

POSITION_TOLERANCE_M = 1e-6
ROTATION_TOLERANCE_RAD = 1e-6
# Below this the error is rounding of the pose itself: where a descent ends does not depend on where it came from.
_CONVERGED = 1e-12
# Decimals of a configuration in rad or m: far finer than a tip is placed, far coarser than the last bits in which
# linear algebra libraries and processors differ.
_DECIMALS = 9
_MAX_ITERATIONS = 60
_MAX_STEP_RAD = 0.6


@dataclass(frozen=True, slots=True, eq=False)
class Descent:
    """Where a descent ended; errors and Jacobian are those before the configuration was rounded.

    Attributes:
        position_error: distance of the tip from the target in metres.
        rotation_error: angle between tip and target in radians.
        jacobian: of the tip there, 6 rows (m, rad).
    """

    configuration: Array
    position_error: float
    rotation_error: float
    jacobian: Array

    @property
    def reached(self) -> bool:
        """Tell whether the tip is at the target within the tolerances."""
        return self.position_error <= POSITION_TOLERANCE_M and self.rotation_error <= ROTATION_TOLERANCE_RAD


def descend(chain: GroupChain, target_to_world: PinTransform, seed: Array, limits: JointLimits | None) -> Descent:
    """Follow the pose error from a seed to a configuration that puts the tip at the target.

    The damping is half the squared error plus a small bias (Sugihara, IEEE Transactions on Robotics 27(5), 2011), so
    the last steps are Gauss-Newton steps and converge quadratically.

    Args:
        target_to_world: transform of the wanted tip to the world.
        limits: position limits held at every step; None lets the joints leave them.
    """
    lower, upper = (None, None) if limits is None else (np.array(limits.lower), np.array(limits.upper))
    configuration = seed.astype(np.float64)
    best, least, least_squared, there = configuration, np.full(6, np.inf), math.inf, np.empty((6, 0))
    for _ in range(_MAX_ITERATIONS):
        tip, jacobian = chain.tip_and_jacobian(configuration)
        error = pinocchio.log6(tip.actInv(target_to_world)).vector
        squared = float(error @ error)
        if squared >= least_squared and least_squared < POSITION_TOLERANCE_M**2:
            break  # rounding has stopped the descent
        if squared < least_squared:
            best, least, least_squared, there = configuration, error, squared, jacobian
        if squared < _CONVERGED**2:
            break
        configuration = configuration + _step(jacobian, error, squared)
        if lower is not None and upper is not None:
            configuration = np.minimum(np.maximum(configuration, lower), upper)
    away, turned = (math.sqrt(float(part @ part)) for part in (least[:3], least[3:]))
    best = np.round(best, _DECIMALS)
    if lower is not None and upper is not None:
        best = np.minimum(np.maximum(best, lower), upper)
    return Descent(best, away, turned, there)


def singular_values(chain: GroupChain, configuration: Array) -> Array:
    """Return the singular values of the tip's Jacobian, largest first; rows in metres and radians."""
    jacobian = chain.tip_and_jacobian(configuration)[1]
    return np.asarray(np.linalg.svd(jacobian, compute_uv=False), dtype=np.float64)


def _step(jacobian: Array, error: Array, squared: float) -> Array:
    normal = jacobian.T @ jacobian
    # The bias keeps the system regular where the arm is redundant or singular.
    normal.flat[:: len(normal) + 1] += 0.5 * squared + 1e-9
    step = np.asarray(np.linalg.solve(normal, jacobian.T @ error), dtype=np.float64)
    if float(step @ step) <= _MAX_STEP_RAD**2:  # no joint goes farther than all of them together
        return step
    return step * min(1.0, _MAX_STEP_RAD / max(_MAX_STEP_RAD, float(np.max(np.abs(step)))))
