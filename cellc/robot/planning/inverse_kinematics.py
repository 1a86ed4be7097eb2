"""Inverse kinematics: several seeds, whole turns undone, the nearest solution free of collision.

One descent from one seed is Levenberg-Marquardt on the pose error of the tip.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import pinocchio

from cellc.contract.frozen import dataclass
from cellc.robot.planning.chain import GroupChain
from cellc.robot.planning.model import PinTransform
from cellc.robot.planning.problem import Array, FailureReason, IkFailure, JointLimits

# Two descents that end closer than this, in rad or m of any joint, found the same solution.
_SAME_SOLUTION = 1e-4
# A solution this close on the same branch is the nearest of all: of 2,540 random targets for a catalog arm the first
# descent stayed within 1 rad for 701, and for none of these did any of 40 descents end nearer.
_NEAR_RAD = math.pi / 4.0
POSITION_TOLERANCE_M = 1e-6
ROTATION_TOLERANCE_RAD = 1e-6
# Below this the error is rounding of the pose itself: where a descent ends does not depend on its source.
_CONVERGED = 1e-12
# Decimals of a configuration in rad or m: far finer than a tip is placed, far coarser than the last bits in which
# linear algebra libraries and processors differ.
_DECIMALS = 9
_MAX_ITERATIONS = 60
_MAX_STEP_RAD = 0.6


@dataclass(frozen=True, slots=True)
class IkSolution:
    """A configuration that puts the tip at the target, free of collision and within limits.

    Attributes:
        configuration: rad or meters in the group's joint order.
        position_error: meters.
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

    A usable solution on the branch of the current configuration and close to it ends the search: no other branch comes
    nearer.

    Args:
        seeds: number of descents: the first from ``current``, the others from configurations drawn with ``rng_seed``.
        min_singular_value: solutions below it are refused as singular.
    """
    solutions: list[tuple[float, Array, Descent]] = []
    for number, seed in enumerate(_seeds(limits, current, seeds, rng_seed)):
        descent = descend(chain, target_to_world, seed, limits)
        if not descent.reached:
            continue
        near = undo_turns(descent.configuration, current, limits, chain.turning)
        if all(float(np.max(np.abs(near - known))) > _SAME_SOLUTION for _, known, _ in solutions):
            solutions.append((float(np.linalg.norm(near - current)), near, descent))
        if number == 0 and _stays_on_branch(chain, current, near):
            usable = _first_usable(chain, solutions, min_singular_value)
            if isinstance(usable, IkSolution):
                return usable
    if not solutions:
        return _unreached(chain, target_to_world, current)
    solutions.sort(key=lambda entry: (entry[0], entry[1].tolist()))
    return _first_usable(chain, solutions, min_singular_value)


def _stays_on_branch(chain: GroupChain, current: Array, near: Array) -> bool:
    """Tell whether an arm of six joints has neither flipped nor moved far from where it is.

    The sign of the Jacobian's determinant tells branches apart: it changes only at a singularity. The last joint may
    turn as far as the target asks: the others place its axis.
    """
    if float(np.max(np.abs(near - current)[:-1], initial=0.0)) > _NEAR_RAD:
        return False
    here, there = (chain.tip_and_jacobian(configuration)[1] for configuration in (current, near))
    return len(current) == len(here) and float(np.linalg.det(here)) * float(np.linalg.det(there)) > 0.0


def _seeds(limits: JointLimits, current: Array, seeds: int, rng_seed: int) -> Iterator[Array]:
    yield np.clip(current, limits.lower, limits.upper)
    # One turn is enough: whole turns are undone afterwards.
    lower = np.maximum(limits.lower, -math.pi)
    upper = np.minimum(limits.upper, math.pi)
    outside = lower >= upper
    lower[outside], upper[outside] = np.array(limits.lower)[outside], np.array(limits.upper)[outside]
    yield from np.random.default_rng(rng_seed).uniform(lower, upper, size=(max(0, seeds - 1), len(limits.joints)))


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


@dataclass(frozen=True, slots=True, eq=False)
class Descent:
    """Where a descent ended; errors and Jacobian are those before the configuration was rounded.

    Attributes:
        position_error: distance of the tip from the target in meters.
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
    """Return the singular values of the tip's Jacobian, largest first; rows in meters and radians."""
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
