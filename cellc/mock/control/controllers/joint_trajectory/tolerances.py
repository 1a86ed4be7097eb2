"""Tolerances of a trajectory: the controller's own, and what a goal makes of them.

Facts: facts/follow_joint_trajectory.md §1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellc.mock.control.interfaces import Array
from cellc.mock.control.log import Log
from cellc.mock.control.messages import JointTolerance, TrajectoryGoal
from cellc.mock.control.parameters import ParameterSet

_ERASE = -1.0


@dataclass(frozen=True, slots=True)
class StateTolerance:
    """Tolerances of all joints; infinite where nothing is checked."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True, slots=True)
class Tolerances:
    """Tolerances on the way, at the end, and of the time at the end (s, 0 waits for ever)."""

    path: StateTolerance
    goal: StateTolerance
    goal_time_s: float


def _enforced(values: Sequence[float]) -> Array:
    """A stored tolerance of 0 or less is not checked."""
    array = np.array(values, dtype=float)
    return np.where(array > 0.0, array, np.inf)


def default_tolerances(parameters: ParameterSet, joints: Sequence[str]) -> Tolerances:
    """The controller's tolerances, from its parameters."""
    unchecked = np.full(len(joints), np.inf)
    stopped = parameters.number("constraints.stopped_velocity_tolerance")
    path = _enforced([parameters.number(f"constraints.{joint}.trajectory") for joint in joints])
    goal = _enforced([parameters.number(f"constraints.{joint}.goal") for joint in joints])
    return Tolerances(
        StateTolerance(path, unchecked, unchecked),
        StateTolerance(goal, _enforced([stopped] * len(joints)), unchecked),
        parameters.number("constraints.goal_time"),
    )


class _RefusedError(Exception):
    """A tolerance that makes the whole goal run with the defaults."""


def _resolve(default: float, given: float, what: str) -> float:
    if given > 0.0:
        return given
    if given == 0.0:
        return default
    if given == _ERASE:
        return np.inf
    raise _RefusedError(f"Illegal {what} tolerance {given:f}, must be -1, 0, or positive. Using default tolerances.")


def _merge(
    default: StateTolerance, given: Sequence[JointTolerance], joints: Sequence[str], field: str
) -> StateTolerance:
    merged = StateTolerance(default.position.copy(), default.velocity.copy(), default.acceleration.copy())
    for tolerance in given:
        if tolerance.name not in joints:
            raise _RefusedError(
                f"joint '{tolerance.name}' specified in goal.{field} does not exist. Using default tolerances."
            )
        index = list(joints).index(tolerance.name)
        merged.position[index] = _resolve(default.position[index], tolerance.position, "position")
        merged.velocity[index] = _resolve(default.velocity[index], tolerance.velocity, "velocity")
        merged.acceleration[index] = _resolve(default.acceleration[index], tolerance.acceleration, "acceleration")
    return merged


def goal_tolerances(
    default: Tolerances, goal: TrajectoryGoal, joints: Sequence[str], log: Log, logger: str
) -> Tolerances:
    """Tolerances of one goal; any mistake in it makes all of its tolerances the defaults."""
    seconds = goal.goal_time_tolerance_ns / 1e9
    goal_time = default.goal_time_s
    try:
        path = _merge(default.path, goal.path_tolerance, joints, "path_tolerance")
        end = _merge(default.goal, goal.goal_tolerance, joints, "goal_tolerance")
    except _RefusedError as refused:
        log.error(f"{logger}.tolerance", str(refused))
        return default
    if seconds > 0.0:
        goal_time = seconds
    elif seconds == _ERASE:
        goal_time = 0.0
    elif seconds < 0.0:
        text = f"Specified illegal goal_time_tolerance: {seconds:f}. Using default tolerances"
        log.error(f"{logger}.tolerance", text)
    return replace(default, path=path, goal=end, goal_time_s=goal_time)
