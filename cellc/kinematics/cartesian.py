"""Straight-line motion of the tip by small steps of inverse kinematics."""

from __future__ import annotations

import math

import numpy as np
import pinocchio

from cellc.kinematics.chain import GroupChain
from cellc.kinematics.edge import edge_is_free
from cellc.kinematics.failure import FailureReason, PlanFailure
from cellc.kinematics.limits import Array, JointLimits
from cellc.kinematics.model import from_pose, to_pose
from cellc.kinematics.path import JointPath
from cellc.kinematics.solve import descend, singular_values
from cellc.transforms import Pose, interpolate

MAX_STEP_M = 0.005
MAX_STEP_RAD = 0.05
# Such a step moves no joint farther than this unless the arm is near a singularity or changes its branch.
MAX_JOINT_STEP_RAD = 0.25


def plan_line(
    chain: GroupChain, limits: JointLimits, start: Array, target_in_world: Pose, *, min_singular_value: float
) -> JointPath | PlanFailure:
    """Lead the tip from where it stands along a straight line, turning along the shorter arc at the same time.

    Args:
        target_in_world: wanted pose of the tip in the world frame.
    """
    first = to_pose(chain.tip(start))
    steps = _step_count(first, target_in_world)
    waypoints = [start]
    for step in range(1, steps + 1):
        here = waypoints[-1]
        guess = here if step == 1 else 2.0 * here - waypoints[-2]
        wanted = from_pose(interpolate(first, target_in_world, step / steps))
        descent = descend(chain, wanted, guess, None)
        if not descent.reached:
            return PlanFailure(FailureReason.NO_IK_SOLUTION, f"{_place(step, steps)}: the tip leaves the line")
        failure = _refuse_step(chain, limits, here, descent.configuration, _place(step, steps), min_singular_value)
        if failure is not None:
            return failure
        waypoints.append(descent.configuration)
    return JointPath(limits.joints, (tuple(tuple(point.tolist()) for point in waypoints),))


def _step_count(start: Pose, goal: Pose) -> int:
    difference = pinocchio.log3(from_pose(start).rotation.T @ from_pose(goal).rotation)
    length, angle = math.dist(start.position, goal.position), float(np.linalg.norm(difference))
    # The tolerance keeps a distance of 100 mm at 20 steps; two steps at least make a spline of the section.
    return max(2, math.ceil(length / MAX_STEP_M - 1e-6), math.ceil(angle / MAX_STEP_RAD - 1e-6))


def _refuse_step(
    chain: GroupChain, limits: JointLimits, here: Array, there: Array, place: str, min_singular_value: float
) -> PlanFailure | None:
    outside = limits.violation(there)
    if outside:
        return PlanFailure(FailureReason.OUT_OF_LIMITS, f"{place}: {outside}")
    least = float(singular_values(chain, there)[-1])
    if least < min_singular_value:
        detail = f"{place}: the least singular value is {least:.3g}, allowed {min_singular_value:.3g} or more"
        return PlanFailure(FailureReason.SINGULAR, detail)
    jump = float(np.max(np.abs(there - here)))
    if jump > MAX_JOINT_STEP_RAD:
        detail = f"{place}: a joint jumps by {jump:.3g} rad, allowed {MAX_JOINT_STEP_RAD} rad"
        return PlanFailure(FailureReason.JOINT_JUMP, detail)
    if not edge_is_free(chain, here, there):
        return PlanFailure(FailureReason.NO_PATH, f"{place}: {chain.describe_contact(there)}")
    return None


def _place(step: int, steps: int) -> str:
    return f"at {step / steps:.0%} of the line"
