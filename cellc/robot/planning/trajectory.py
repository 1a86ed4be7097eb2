"""A path with times: jerk-limited motion, as the points of a FollowJointTrajectory goal.

Each section is run from rest to rest by one motion law of its parameter, so that all joints keep to the path exactly.
Points lie at every instant at which the jerk changes. On a straight edge each joint's position is one cubic between two
such points, and the controller's quintic through position, velocity and acceleration is that cubic itself.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.robot.planning.motion_law import (
    MotionLaw,
    ParameterBounds,
    fastest_bounds,
    jerk_changes,
    moving,
    rest_to_rest,
)
from cellc.robot.planning.problem import Array, Configuration, JointLimits, JointPath, LimitsError
from cellc.robot.planning.splines import SectionCurve, extremes, quintic_coefficients

# Planned use of the limits: room for the rounding of times to nanoseconds.
_TARGET_USE = 1.0 - 1e-6
# Use at which a section is fast enough to be left as it is.
_LEAST_USE = 1.0 - 1e-3
# Points closer than this would let rounding of positions look like jerk: 60 * 2e-16 rad / (1e-4 s)^3 = 0.01 rad/s^3.
_LEAST_SPACING_NS = 100_000
# A jerk phase that is shorter has no point of its own, and the interpolation misses it: less jerk is used.
_SHORTEST_PHASE_S = 1.1e-9 * _LEAST_SPACING_NS
# Rad or m: a joint that is measured so near to its goal is there; ruckig finds no law for such a way.
_STANDS = 1e-12
_MAX_RESCALINGS = 8
_KEPT_SECTIONS = 64
# Three years; 64 bits hold the nanoseconds of many such sections.
_LONGEST_S = 1e8


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """One trajectory_msgs/JointTrajectoryPoint: rad, rad/s, rad/s², or meters for prismatic joints."""

    time_from_start_ns: int
    positions: Configuration
    velocities: Configuration
    accelerations: Configuration


@dataclass(frozen=True, slots=True)
class LimitUse:
    """How much of the limits the controller's interpolation uses, at most, over all joints.

    Attributes:
        velocity: largest share of a velocity limit; 1 is the whole limit.
        acceleration: largest share of an acceleration limit.
        jerk: largest share of a jerk limit.
        position_margin: least distance from a position limit in rad or meters; negative outside.
    """

    velocity: float
    acceleration: float
    jerk: float
    position_margin: float

    @property
    def as_speed(self) -> float:
        """The share of the highest speed at which the whole motion could be run in time; above 1 it breaks a limit."""
        return max(self.velocity, math.sqrt(self.acceleration), math.pow(self.jerk, 1.0 / 3.0))


@dataclass(frozen=True, slots=True)
class TimedTrajectory:
    """Points between which the controller's quintic interpolation stays within limits.

    Attributes:
        points: the first at time 0 where the robot is, the last at rest; times rise by 0.1 ms or more.
        limit_use: guaranteed for the interpolated motion, not only at the points.
    """

    joints: tuple[str, ...]
    points: tuple[TrajectoryPoint, ...]
    limit_use: LimitUse

    @property
    def duration_ns(self) -> int:
        """Time of the last point in nanoseconds."""
        return self.points[-1].time_from_start_ns


def time_parameterize(
    path: JointPath, limits: JointLimits, *, start_velocity: Sequence[float] | None = None
) -> TimedTrajectory:
    """Give a path times, as short as the limits allow section by section.

    Args:
        limits: of the path's joints, in the same order.
        start_velocity: rad/s or m/s, at rest where absent. A moving start leaves the straight edge of the first section
            while it brakes; look at ``limit_use.position_margin`` and check the way for collisions.

    Raises:
        LimitsError: ruckig finds no motion within the limits.
        ValueError: the limits are of other joints, or a moving start meets a first section that is no straight edge.
    """
    if limits.joints != path.joints:
        raise ValueError(f"the limits are for {limits.joints}, the path has {path.joints}")
    sections = []
    for index, waypoints in enumerate(path.sections):
        if index == 0 and start_velocity is not None and any(start_velocity):
            sections.append(time_moving(waypoints, start_velocity, limits))
        elif any(math.dist(waypoint, waypoints[0]) > _STANDS for waypoint in waypoints):
            sections.append(time_at_rest(waypoints, limits))
    if not sections:
        return _standstill(path, limits)
    return TimedTrajectory(path.joints, _join(sections), _overall([section.limit_use for section in sections]))


def _join(sections: list[TimedSection]) -> tuple[TrajectoryPoint, ...]:
    points: list[TrajectoryPoint] = []
    begin = 0
    for section in sections:
        first = 0 if not points else 1  # the standstill between two sections is one point
        rows = list(zip(section.times_ns, *(state.tolist() for state in section.states), strict=True))
        for time, position, velocity, acceleration in rows[first:]:
            points.append(TrajectoryPoint(begin + time, tuple(position), tuple(velocity), tuple(acceleration)))
        begin += section.times_ns[-1]
    return tuple(points)


def _overall(uses: list[LimitUse]) -> LimitUse:
    return LimitUse(
        max(use.velocity for use in uses),
        max(use.acceleration for use in uses),
        max(use.jerk for use in uses),
        min(use.position_margin for use in uses),
    )


def _standstill(path: JointPath, limits: JointLimits) -> TimedTrajectory:
    rest = tuple(0.0 for _ in path.joints)
    state = np.array([path.start])
    use = measure_use([0], (state, np.zeros_like(state), np.zeros_like(state)), limits)
    return TimedTrajectory(path.joints, (TrajectoryPoint(0, path.start, rest, rest),), use)


@dataclass(frozen=True, slots=True, eq=False)
class TimedSection:
    """Points of one section: nanoseconds from its own start, and states of shape (points, joints)."""

    times_ns: list[int]
    states: tuple[Array, Array, Array]
    limit_use: LimitUse


@lru_cache(maxsize=_KEPT_SECTIONS)
def time_at_rest(waypoints: tuple[Configuration, ...], limits: JointLimits) -> TimedSection:
    """Run a section from rest to rest, rescaled in time until the interpolated motion just keeps the limits.

    Kept, since runs that differ in where an object lies go on alike from where it is put down.
    """
    curve = SectionCurve(waypoints)
    speed, surge, jerk = _scaled(fastest_bounds(curve, limits), _TARGET_USE)
    bounds = speed, surge, min(jerk, surge / _SHORTEST_PHASE_S)
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
    """Round instants to nanoseconds and leave out those too close to others; the ends stay, crossings yield first.

    Raises:
        LimitsError: the motion takes longer than nanoseconds can count.
    """
    if not changes[-1] <= _LONGEST_S:
        raise LimitsError(f"a motion within the limits takes {changes[-1]:.3g} s, at most {_LONGEST_S:g} s are planned")
    end = -int(-changes[-1] * 1e9 // 1)  # upwards: the motion is over at the last point
    times = [0, max(end, _LEAST_SPACING_NS)]
    for instant in (*changes, *crossings):
        time = round(instant * 1e9)
        place = bisect_left(times, time)
        if all(abs(time - other) >= _LEAST_SPACING_NS for other in times[max(0, place - 1) : place + 1]):
            times.insert(place, time)
    return times


def measure_use(times_ns: list[int], states: tuple[Array, Array, Array], limits: JointLimits) -> LimitUse:
    """Bound the use of the limits by the quintics between points.

    Args:
        times_ns: rising times of the points.
        states: positions, velocities and accelerations, each of shape (points, joints).
    """
    if len(times_ns) == 1:
        margin = np.minimum(states[0] - limits.lower, np.array(limits.upper) - states[0])
        return LimitUse(0.0, 0.0, 0.0, float(np.min(margin)))
    durations = np.diff(np.array(times_ns, dtype=np.int64)).astype(np.float64) * 1e-9
    coefficients = quintic_coefficients(durations, states)
    lowest, highest = extremes(coefficients, durations, 0)
    margin = np.minimum(lowest - limits.lower, np.array(limits.upper) - highest)
    shares = []
    for order, limit in ((1, limits.velocity), (2, limits.acceleration), (3, limits.jerk)):
        least, greatest = extremes(coefficients, durations, order)
        shares.append(float(np.max(np.maximum(-least, greatest) / np.array(limit))))
    return LimitUse(shares[0], shares[1], shares[2], float(np.min(margin)))
