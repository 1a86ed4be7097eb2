"""Jerk-limited motion laws from ruckig, and how fast the parameter of a section may run under joint limits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, count
from typing import Any

import numpy as np
import ruckig

from cellc.robot.planning.problem import Array, JointLimits, LimitsError
from cellc.robot.planning.splines import SectionCurve

# ruckig ships no type information: its trajectory is Any, and stays inside this package.
MotionLaw = Any
ParameterBounds = tuple[float, float, float]
_SPEED_RATIO = 0.8
_ACCELERATION_SHARES = (1.0, 0.5, 0.25)
_SPEEDS_AT_ONCE = 24


def rest_to_rest(bounds: tuple[float, float, float]) -> MotionLaw:
    """Return the fastest law of one parameter from rest at 0 to rest at 1; bounds on its first three derivatives."""
    velocity, acceleration, jerk = bounds
    return moving((0.0,), (0.0,), (1.0,), (velocity,), (acceleration,), (jerk,))


def rest_to_rest_durations(bounds: Array) -> Array:
    """Return how long the laws of ``rest_to_rest`` take: seven phases of constant jerk, some of them empty.

    Args:
        bounds: rows of bounds on velocity, acceleration and jerk.
    """
    velocity, acceleration, jerk = bounds.T
    # A ramp takes the acceleration from zero to its bound, or only to what is needed for full speed.
    ramp = np.where(velocity * jerk < acceleration**2, np.sqrt(velocity / jerk), acceleration / jerk)
    rise = ramp + velocity / (ramp * jerk)
    # A way that ends before full speed is rising for its first half, with or without a stretch of full acceleration.
    full_ramp = acceleration / jerk
    halfway = np.where(
        2.0 * acceleration**3 <= jerk**2,
        full_ramp / 2.0 + np.sqrt(full_ramp**2 / 4.0 + 1.0 / acceleration),
        2.0 * np.cbrt(0.5 / jerk),
    )
    return np.asarray(np.where(velocity * rise <= 1.0, rise + 1.0 / velocity, 2.0 * halfway))


def moving(
    start: Sequence[float],
    start_velocity: Sequence[float],
    goal: Sequence[float],
    velocity: Sequence[float],
    acceleration: Sequence[float],
    jerk: Sequence[float],
) -> MotionLaw:
    """Return the law that brings all joints to rest at the goal at the same time.

    Raises:
        LimitsError: ruckig finds no law, with its own word for the reason.
    """
    count = len(start)
    request = ruckig.InputParameter(count)
    request.current_position, request.current_velocity = list(start), list(start_velocity)
    request.target_position = list(goal)
    request.max_velocity, request.max_acceleration = list(velocity), list(acceleration)
    request.max_jerk = list(jerk)
    law = ruckig.Trajectory(count)
    try:
        result = ruckig.Ruckig(count).calculate(request, law)
    except ruckig.RuckigError as error:
        raise LimitsError(f"no motion law: {error}") from None
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        raise LimitsError(f"no motion law: ruckig ends with {result.name}")
    return law


def jerk_changes(law: MotionLaw) -> list[float]:
    """Return the instants in seconds at which the jerk of any joint may change, sorted, from 0 to the duration.

    Between two neighbors every joint's position is one cubic of time.
    """
    instants = {0.0, float(law.duration)}
    for profile in law.profiles[0]:
        instants.update(accumulate((*profile.brake.t, *profile.t)))
    return sorted(instant for instant in instants if instant <= law.duration)


def fastest_bounds(curve: SectionCurve, limits: JointLimits) -> ParameterBounds:
    """Choose bounds on the parameter's velocity, acceleration and jerk (1/s, 1/s², 1/s³).

    By the chain rule a joint's acceleration is ``q's'' + q''s'²`` and its jerk ``q's''' + 3q''s's'' + q'''s'³``: on a
    curve, speed is paid for with acceleration and jerk, so ever lower speeds are tried until they can shorten nothing.
    """
    slope, bend, twist = curve.steepest()
    # A joint that is at standstill bounds nothing; the floor keeps its quotient finite.
    steepness = (np.maximum(slope, 1e-12), bend, twist)
    highest = float(np.min(np.array(limits.velocity) / steepness[0]))
    if not np.any(bend):  # without curvature there is always room
        return _row(_bounds_at([highest], steepness, limits)[0])
    best, shortest = (highest, 0.0, 0.0), float("inf")
    for first in count(0, _SPEEDS_AT_ONCE):
        speeds = [highest * _SPEED_RATIO**attempt for attempt in range(first, first + _SPEEDS_AT_ONCE)]
        bounds = _bounds_at(speeds, steepness, limits)
        durations = rest_to_rest_durations(bounds)
        if durations.size and float(np.min(durations)) < shortest:
            best, shortest = _row(bounds[np.argmin(durations)]), float(np.min(durations))
        if 1.0 / speeds[-1] > shortest:  # even at this speed throughout it takes longer
            return best
    raise AssertionError("the count of attempts has no end")


def _bounds_at(speeds: list[float], steepness: tuple[Array, Array, Array], limits: JointLimits) -> Array:
    """Return bounds that keep the limits, in rows of velocity, acceleration and jerk.

    One row for each share of the acceleration at each speed, the highest first, where the limits leave room for it.
    """
    slope, bend, twist = steepness
    velocity, square, cube = (np.array([[speed**power] for speed in speeds]) for power in (1, 2, 3))
    room = np.array(limits.acceleration) - bend * square
    acceleration = np.min(room / slope, axis=1, keepdims=True) * np.array(_ACCELERATION_SHARES)
    spent = np.array(limits.jerk) - twist * cube, 3.0 * bend * velocity
    left = spent[0][:, np.newaxis] - spent[1][:, np.newaxis] * acceleration[:, :, np.newaxis]
    jerk = np.min(left / slope, axis=2)
    usable = np.all(room > 0.0, axis=1, keepdims=True) & np.all(left > 0.0, axis=2)
    return np.asarray(np.stack((np.broadcast_to(velocity, jerk.shape), acceleration, jerk), axis=2)[usable])


def _row(bounds: Array) -> ParameterBounds:
    velocity, acceleration, jerk = bounds.tolist()
    return velocity, acceleration, jerk
