"""Jerk-limited motion laws from ruckig, and the instants at which a jerk changes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Any

import numpy as np
import ruckig

from cellc.planning.failure import LimitsError
from cellc.planning.limits import Array

# ruckig ships no type information: its trajectory is Any, and stays inside this package.
MotionLaw = Any


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

    Between two neighbours every joint's position is one cubic of time.
    """
    instants = {0.0, float(law.duration)}
    for profile in law.profiles[0]:
        instants.update(accumulate((*profile.brake.t, *profile.t)))
    return sorted(instant for instant in instants if instant <= law.duration)
