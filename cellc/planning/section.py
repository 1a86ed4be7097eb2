"""One section of a path with times: from rest to rest along the curve, or braking from a moving start."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellc.planning.limits import Array, JointLimits
from cellc.planning.profile import MotionLaw, jerk_changes, moving, rest_to_rest
from cellc.planning.speed import ParameterBounds, fastest_bounds
from cellc.planning.spline import SectionCurve
from cellc.planning.trajectory import LimitUse, measure_use

# Planned use of the limits: room for the rounding of times to nanoseconds.
_TARGET_USE = 1.0 - 1e-6
# Use at which a section is fast enough to be left as it is.
_LEAST_USE = 1.0 - 1e-3
# Points closer than this would let rounding of positions look like jerk: 60 * 2e-16 rad / (1e-4 s)^3 = 0.01 rad/s^3.
_LEAST_SPACING_NS = 100_000
_MAX_RESCALINGS = 8


@dataclass(frozen=True, slots=True, eq=False)
class TimedSection:
    """Points of one section: nanoseconds from its own start, and states of shape (points, joints)."""

    times_ns: list[int]
    states: tuple[Array, Array, Array]
    limit_use: LimitUse


def time_at_rest(waypoints: Sequence[Sequence[float]], limits: JointLimits) -> TimedSection:
    """Run a section from rest to rest, rescaled in time until the interpolated motion just keeps the limits."""
    curve = SectionCurve(waypoints)
    bounds = _scaled(fastest_bounds(curve, limits), _TARGET_USE)
    section = _sample(curve, rest_to_rest(bounds), limits)
    for rescaling in range(_MAX_RESCALINGS):
        use = section.limit_use.as_speed
        # Faster only once: a phase too short for a point of its own may come and go with the scale.
        if _LEAST_USE < use <= 1.0 or (use <= 1.0 and rescaling > 0):
            break
        bounds = _scaled(bounds, _TARGET_USE / use)
        section = _sample(curve, rest_to_rest(bounds), limits)
    return section


def time_moving(
    waypoints: Sequence[Sequence[float]], start_velocity: Sequence[float], limits: JointLimits
) -> TimedSection:
    """Bring all joints from a moving start to rest at the end of a straight edge, off the edge while they brake."""
    if len(waypoints) != 2:
        raise ValueError("a moving start needs a straight edge as the first section")
    law = moving(waypoints[0], start_velocity, waypoints[1], limits.velocity, limits.acceleration, limits.jerk)
    times = _spaced(jerk_changes(law), [])
    motion = np.array([law.at_time(time * 1e-9) for time in times])
    motion[-1, 0], motion[-1, 1:] = waypoints[1], 0.0
    states = (motion[:, 0], motion[:, 1], motion[:, 2])
    return TimedSection(times, states, measure_use(times, states, limits))


def _scaled(bounds: ParameterBounds, speed: float) -> ParameterBounds:
    return bounds[0] * speed, bounds[1] * speed**2, bounds[2] * speed**3


def _sample(curve: SectionCurve, law: MotionLaw, limits: JointLimits) -> TimedSection:
    """Put points where the jerk of the law or of the curve changes; both ends exactly at rest on their waypoints."""
    crossings = [law.get_first_time_at_position(0, knot) for knot in curve.inner_knots]
    times = _spaced(jerk_changes(law), [crossing for crossing in crossings if crossing is not None])
    motion = np.array([[values[0] for values in law.at_time(time * 1e-9)] for time in times])
    motion[0], motion[-1] = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    rate, surge = motion[:, 1:2], motion[:, 2:3]
    value, slope, bend, _ = curve.derivatives(motion[:, 0])
    states = (value, slope * rate, slope * surge + bend * rate**2)
    return TimedSection(times, states, measure_use(times, states, limits))


def _spaced(changes: list[float], crossings: list[float]) -> list[int]:
    """Round instants to nanoseconds and leave out those too close to others; the ends stay, crossings yield first."""
    end = -int(-changes[-1] * 1e9 // 1)  # upwards: the motion is over at the last point
    kept = [0, max(end, _LEAST_SPACING_NS)]
    for instant in (*changes, *crossings):
        time = round(instant * 1e9)
        place = bisect_left(kept, time)
        if all(abs(time - other) >= _LEAST_SPACING_NS for other in kept[max(0, place - 1) : place + 1]):
            kept.insert(place, time)
    return kept
