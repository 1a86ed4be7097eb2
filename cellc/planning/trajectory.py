"""A timed trajectory as a FollowJointTrajectory goal carries it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cellc.planning.limits import Array, JointLimits
from cellc.planning.path import Configuration
from cellc.planning.quintic import extremes, quintic_coefficients


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """One trajectory_msgs/JointTrajectoryPoint: rad, rad/s, rad/s², or metres for prismatic joints."""

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
        position_margin: least distance from a position limit in rad or metres; negative outside.
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
        points: the first at time 0 where the robot stands, the last at rest; times rise by 0.1 ms or more.
        limit_use: guaranteed for the interpolated motion, not only at the points.
    """

    joints: tuple[str, ...]
    points: tuple[TrajectoryPoint, ...]
    limit_use: LimitUse

    @property
    def duration_ns(self) -> int:
        """Time of the last point in nanoseconds."""
        return self.points[-1].time_from_start_ns


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
