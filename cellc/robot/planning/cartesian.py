"""Straight-line motion of the tip by small steps of inverse kinematics."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pinocchio

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, interpolate
from cellc.robot.planning.chain import FollowedLine, GroupChain
from cellc.robot.planning.inverse_kinematics import descend
from cellc.robot.planning.model import from_pose, to_pose
from cellc.robot.planning.problem import Array, FailureReason, JointLimits, JointPath, PlanFailure
from cellc.robot.planning.rrt_connect import check_lengths

MAX_STEP_M = 0.005
MAX_STEP_RAD = 0.05
# Such a step moves no joint farther than this unless the arm is near a singularity or changes its branch.
MAX_JOINT_STEP_RAD = 0.25
_KEPT_LINES = 16
# Weights of the last waypoint, the one before it, and so on, by how many there are.
_EXTRAPOLATION = ((1.0,), (2.0, -1.0), (3.0, -3.0, 1.0), (4.0, -6.0, 4.0, -1.0))


@dataclass(frozen=True, slots=True)
class _Refusal:
    """Why a step of a line, counted from 1, may not be driven."""

    step: int
    reason: FailureReason
    detail: str


def plan_line(
    chain: GroupChain, limits: JointLimits, start: Array, target_in_world: Pose, *, min_singular_value: float
) -> JointPath | PlanFailure:
    """Lead the tip from where it is along a straight line, turning along the shorter arc at the same time.

    Args:
        target_in_world: wanted pose of the tip in the world frame.
    """
    line = _line(chain, start, target_in_world)
    steps, waypoints, jacobians = line.steps, line.waypoints, line.jacobians
    refusal = _first_refusal(chain, limits, waypoints, jacobians, min_singular_value)
    if refusal is not None:
        return PlanFailure(refusal.reason, f"{_place(refusal.step, steps)}: {refusal.detail}")
    if len(waypoints) <= steps:
        detail = f"{_place(len(waypoints), steps)}: the tip leaves the line"
        return PlanFailure(FailureReason.NO_IK_SOLUTION, detail)
    return JointPath(limits.joints, (tuple(tuple(point) for point in waypoints.tolist()),))


def _line(chain: GroupChain, start: Array, target_in_world: Pose) -> FollowedLine:
    """Follow a line, or remember the result: what the arm carries changes what touches, and not where it goes."""
    key = (chain.rest.tobytes(), start.tobytes(), target_in_world)
    line = chain.lines.pop(key, None)
    if line is None:
        first = to_pose(chain.tip(start))
        steps = _step_count(first, target_in_world)
        line = _follow(
            chain, start, [interpolate(first, target_in_world, step / steps) for step in range(1, steps + 1)]
        )
    chain.lines[key] = line
    if len(chain.lines) > _KEPT_LINES:
        del chain.lines[next(iter(chain.lines))]
    return line


def _follow(chain: GroupChain, start: Array, poses: Sequence[Pose]) -> FollowedLine:
    """Solve for pose after pose, each from where the ones before it lead to."""
    waypoints, jacobians = [start], []
    for pose in poses:
        descent = descend(chain, from_pose(pose), _extrapolated(waypoints), None)
        if not descent.reached:
            break
        waypoints.append(descent.configuration)
        jacobians.append(descent.jacobian)
    return FollowedLine(len(poses), np.array(waypoints), np.array(jacobians))


def _extrapolated(waypoints: list[Array]) -> Array:
    """Go on along the cubic through the last four waypoints, or the polynomial through fewer where there are fewer.

    A redundant arm goes on along a line: what a higher order adds to motion that its tip does not show, nothing calls
    back.
    """
    highest = len(_EXTRAPOLATION) if len(waypoints[0]) <= 6 else 2
    weights = _EXTRAPOLATION[min(len(waypoints), highest) - 1]
    guess = weights[0] * waypoints[-1]
    for back, weight in enumerate(weights[1:], start=2):
        guess = guess + weight * waypoints[-back]
    return guess


def _step_count(start: Pose, goal: Pose) -> int:
    difference = pinocchio.log3(from_pose(start).rotation.T @ from_pose(goal).rotation)
    length, angle = math.dist(start.position, goal.position), float(np.linalg.norm(difference))
    # The tolerance keeps a distance of 100 mm at 20 steps; two steps at least make a spline of the section.
    return max(2, math.ceil(length / MAX_STEP_M - 1e-6), math.ceil(angle / MAX_STEP_RAD - 1e-6))


def _first_refusal(
    chain: GroupChain, limits: JointLimits, waypoints: Array, jacobians: Array, min_singular_value: float
) -> _Refusal | None:
    """Return the first step of a followed line that may not be driven; the start is taken as checked."""
    if not len(jacobians):
        return None
    least = np.linalg.svd(jacobians, compute_uv=False)[:, -1]
    jumps = np.max(np.abs(np.diff(waypoints, axis=0)), axis=1)
    inside = np.all((waypoints[1:] >= limits.lower) & (waypoints[1:] <= limits.upper), axis=1)
    refused = np.flatnonzero(~inside | (least < min_singular_value) | (jumps > MAX_JOINT_STEP_RAD))
    end = len(jacobians) if not refused.size else int(refused[0])
    touching = _first_touching(chain, waypoints[: end + 1])
    if touching is not None:
        return _Refusal(touching[0], FailureReason.NO_PATH, chain.describe_contact(touching[1]))
    if not refused.size:
        return None
    if not inside[end]:
        return _Refusal(end + 1, FailureReason.OUT_OF_LIMITS, limits.violation(waypoints[end + 1]))
    if least[end] < min_singular_value:
        detail = f"the least singular value is {least[end]:.3g}, allowed {min_singular_value:.3g} or more"
        return _Refusal(end + 1, FailureReason.SINGULAR, detail)
    detail = f"a joint jumps by {jumps[end]:.3g} rad, allowed {MAX_JOINT_STEP_RAD} rad"
    return _Refusal(end + 1, FailureReason.JOINT_JUMP, detail)


def _first_touching(chain: GroupChain, waypoints: Array) -> tuple[int, Array] | None:
    """Return the first step at which a polyline of small steps meets a collision, and where; the start is checked."""
    if len(waypoints) == 1:
        return None
    differences = np.diff(waypoints, axis=0)
    lengths = np.maximum(check_lengths(chain, differences), 1e-12)
    ends = np.cumsum(lengths)
    count = math.ceil(float(np.sum(lengths)))
    marks = np.arange(1, count + 1) * (ends[-1:] / count)
    steps = np.minimum(np.searchsorted(ends, marks), len(ends) - 1)
    shares = 1.0 - (ends[steps] - marks) / lengths[steps]
    checked = waypoints[steps] + shares[:, np.newaxis] * differences[steps]
    row = chain.first_collision(checked)
    return None if row is None else (int(steps[row]) + 1, checked[row])


def _place(step: int, steps: int) -> str:
    return f"at {step / steps:.0%} of the line"
