"""How fast the parameter of a section may run, so that every joint keeps its limits."""

from __future__ import annotations

from itertools import count

import numpy as np

from cellc.kinematics.limits import Array, JointLimits
from cellc.kinematics.profile import rest_to_rest
from cellc.kinematics.spline import SectionCurve

ParameterBounds = tuple[float, float, float]

_SPEED_RATIO = 0.8
_ACCELERATION_SHARES = (1.0, 0.5, 0.25)


def fastest_bounds(curve: SectionCurve, limits: JointLimits) -> ParameterBounds:
    """Choose bounds on the parameter's velocity, acceleration and jerk (1/s, 1/s², 1/s³).

    By the chain rule a joint's acceleration is ``q's'' + q''s'²`` and its jerk ``q's''' + 3q''s's'' + q'''s'³``: on a
    curve, speed is paid for with acceleration and jerk, so ever lower speeds are tried until they can shorten nothing.
    """
    steepness = _without_standing_joints(curve.steepest())
    highest = float(np.min(np.array(limits.velocity) / steepness[0]))
    if not np.any(steepness[1]):
        bounds = _bounds_at(highest, 1.0, steepness, limits)
        assert bounds is not None  # without curvature there is always room
        return bounds
    best: ParameterBounds | None = None
    shortest = float("inf")
    for attempt in count():
        velocity = highest * _SPEED_RATIO**attempt
        if best is not None and 1.0 / velocity > shortest:  # even at this speed throughout it takes longer
            return best
        for share in _ACCELERATION_SHARES:
            bounds = _bounds_at(velocity, share, steepness, limits)
            duration = float("inf") if bounds is None else float(rest_to_rest(bounds).duration)
            if duration < shortest:
                best, shortest = bounds, duration
    raise AssertionError("the count of attempts has no end")


def _without_standing_joints(steepness: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
    # A joint that stands still bounds nothing; the floor keeps its quotient finite.
    return np.maximum(steepness[0], 1e-12), steepness[1], steepness[2]


def _bounds_at(
    velocity: float, share: float, steepness: tuple[Array, Array, Array], limits: JointLimits
) -> ParameterBounds | None:
    slope, bend, twist = steepness
    room = np.array(limits.acceleration) - bend * velocity**2
    if np.any(room <= 0.0):
        return None
    acceleration = share * float(np.min(room / slope))
    room = np.array(limits.jerk) - twist * velocity**3 - 3.0 * bend * velocity * acceleration
    return None if np.any(room <= 0.0) else (velocity, acceleration, float(np.min(room / slope)))
