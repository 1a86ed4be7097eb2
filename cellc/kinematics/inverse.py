"""Inverse kinematics: several seeds, whole turns undone, the nearest solution free of collision."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cellc.kinematics.chain import GroupChain
from cellc.kinematics.failure import FailureReason, IkFailure
from cellc.kinematics.limits import Array, JointLimits
from cellc.kinematics.model import PinTransform
from cellc.kinematics.solve import Descent, descend, singular_values

# Two descents that end closer than this, in rad or m of any joint, found the same solution.
_SAME_SOLUTION = 1e-4


@dataclass(frozen=True, slots=True)
class IkSolution:
    """A configuration that puts the tip at the target, free of collision and within limits.

    Attributes:
        configuration: rad or metres in the group's joint order.
        position_error: metres.
        rotation_error: radians.
        min_singular_value: least singular value of the tip's Jacobian (rows in m and rad); 0 at a singularity.
        manipulability: product of the singular values (Yoshikawa 1985).
    """

    configuration: tuple[float, ...]
    position_error: float
    rotation_error: float
    min_singular_value: float
    manipulability: float


def solve_inverse(
    chain: GroupChain,
    limits: JointLimits,
    target_to_world: PinTransform,
    current: Array,
    *,
    seeds: int,
    rng_seed: int,
    min_singular_value: float,
) -> IkSolution | IkFailure:
    """Find the solution nearest to the current configuration.

    Args:
        seeds: number of descents: the first from ``current``, the others from configurations drawn with ``rng_seed``.
        min_singular_value: solutions below it are refused as singular.
    """
    found: list[tuple[float, Array, Descent]] = []
    for seed in _seeds(limits, current, seeds, rng_seed):
        descent = descend(chain, target_to_world, seed, limits)
        if not descent.reached:
            continue
        near = undo_turns(descent.configuration, current, limits, chain.turning)
        if all(float(np.max(np.abs(near - known))) > _SAME_SOLUTION for _, known, _ in found):
            found.append((float(np.linalg.norm(near - current)), near, descent))
    if not found:
        return _unreached(chain, target_to_world, current)
    found.sort(key=lambda entry: (entry[0], entry[1].tolist()))
    return _first_usable(chain, found, min_singular_value)


def _seeds(limits: JointLimits, current: Array, seeds: int, rng_seed: int) -> list[Array]:
    # One turn is enough: whole turns are undone afterwards.
    lower = np.maximum(limits.lower, -math.pi)
    upper = np.minimum(limits.upper, math.pi)
    outside = lower >= upper
    lower[outside], upper[outside] = np.array(limits.lower)[outside], np.array(limits.upper)[outside]
    drawn = np.random.default_rng(rng_seed).uniform(lower, upper, size=(max(0, seeds - 1), len(limits.joints)))
    return [np.clip(current, limits.lower, limits.upper), *drawn]


def undo_turns(configuration: Array, current: Array, limits: JointLimits, turning: npt.NDArray[np.bool_]) -> Array:
    """Move turning joints by whole turns to the place within limits that is nearest to the current one."""
    turn = 2.0 * math.pi
    near: Array = configuration.copy()
    for at in np.flatnonzero(turning):
        wanted = round((current[at] - configuration[at]) / turn)
        choices = [configuration[at] + turn * (wanted + shift) for shift in (0, -1, 1)]
        inside = [value for value in choices if limits.lower[at] <= value <= limits.upper[at]]
        if inside:
            near[at] = min(inside, key=lambda value: (abs(value - current[at]), value))
    return near


def _unreached(chain: GroupChain, target_to_world: PinTransform, current: Array) -> IkFailure:
    free = descend(chain, target_to_world, current, None)
    if free.reached:
        return IkFailure(FailureReason.OUT_OF_LIMITS, "the target is reached only outside the joint position limits")
    detail = f"the nearest tip stays {free.position_error:.4g} m and {free.rotation_error:.4g} rad from the target"
    return IkFailure(FailureReason.NO_IK_SOLUTION, detail)


def _first_usable(
    chain: GroupChain, found: list[tuple[float, Array, Descent]], min_singular_value: float
) -> IkSolution | IkFailure:
    failure: IkFailure | None = None
    for _, configuration, descent in found:
        values = singular_values(chain, configuration)
        least = float(values[-1])
        if chain.collides(configuration):
            failure = failure or IkFailure(FailureReason.GOAL_IN_COLLISION, chain.describe_contact(configuration))
        elif least < min_singular_value:
            detail = f"the least singular value is {least:.3g}, allowed {min_singular_value:.3g} or more"
            failure = failure or IkFailure(FailureReason.SINGULAR, detail)
        else:
            manipulability = float(np.prod(values))
            joints = tuple(configuration.tolist())
            return IkSolution(joints, descent.position_error, descent.rotation_error, least, manipulability)
    assert failure is not None  # each solution that was not returned left a reason
    return failure
