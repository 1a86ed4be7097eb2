"""How fast the parameter of a section may run, so that every joint keeps its limits."""

from __future__ import annotations

from itertools import count

import numpy as np

from cellc.planning.limits import Array, JointLimits
from cellc.planning.profile import rest_to_rest_durations
from cellc.planning.spline import SectionCurve

ParameterBounds = tuple[float, float, float]

_SPEED_RATIO = 0.8
_ACCELERATION_SHARES = (1.0, 0.5, 0.25)
_SPEEDS_AT_ONCE = 24


def fastest_bounds(curve: SectionCurve, limits: JointLimits) -> ParameterBounds:
    """Choose bounds on the parameter's velocity, acceleration and jerk (1/s, 1/s², 1/s³).

    By the chain rule a joint's acceleration is ``q's'' + q''s'²`` and its jerk ``q's''' + 3q''s's'' + q'''s'³``: on a
    curve, speed is paid for with acceleration and jerk, so ever lower speeds are tried until they can shorten nothing.
    """
    slope, bend, twist = curve.steepest()
    # A joint that stands still bounds nothing; the floor keeps its quotient finite.
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
