"""A trajectory in joint space, sampled at any time: what an action goal asks for."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise


@dataclass(frozen=True, slots=True)
class Waypoint:
    """Joint positions, velocities and accelerations at a time from the start; rad or m, per second, per second²."""

    time_s: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    accelerations: tuple[float, ...]


class Trajectory:
    """Waypoints joined by polynomials of fifth degree, which meet position, velocity and acceleration at both ends."""

    def __init__(self, waypoints: tuple[Waypoint, ...]) -> None:
        """Bind at least two waypoints in rising order of time.

        Raises:
            ValueError: there are fewer, or time does not rise.
        """
        if len(waypoints) < 2:
            raise ValueError("a trajectory needs a start and an end")
        if any(after.time_s <= before.time_s for before, after in pairwise(waypoints)):
            raise ValueError("the times of a trajectory must rise")
        self.waypoints = waypoints
        self._times = [waypoint.time_s for waypoint in waypoints]

    @property
    def duration_s(self) -> float:
        """Time of the last waypoint."""
        return self._times[-1]

    def positions(self, time_s: float) -> tuple[float, ...]:
        """Return the joint positions at a time; those of the ends outside."""
        if time_s <= self._times[0]:
            return self.waypoints[0].positions
        if time_s >= self._times[-1]:
            return self.waypoints[-1].positions
        index = bisect_right(self._times, time_s)
        before, after = self.waypoints[index - 1], self.waypoints[index]
        span_s = after.time_s - before.time_s
        share = (time_s - before.time_s) / span_s
        return tuple(_quintic(before, after, joint, span_s, share) for joint in range(len(before.positions)))


def _quintic(before: Waypoint, after: Waypoint, joint: int, span_s: float, share: float) -> float:
    """Return one joint at a share of a segment, by the six Hermite polynomials of fifth degree."""
    s2 = share * share
    s3 = s2 * share
    s4 = s3 * share
    s5 = s4 * share
    return (
        before.positions[joint] * (1.0 - 10.0 * s3 + 15.0 * s4 - 6.0 * s5)
        + after.positions[joint] * (10.0 * s3 - 15.0 * s4 + 6.0 * s5)
        + span_s * before.velocities[joint] * (share - 6.0 * s3 + 8.0 * s4 - 3.0 * s5)
        + span_s * after.velocities[joint] * (-4.0 * s3 + 7.0 * s4 - 3.0 * s5)
        + span_s * span_s * before.accelerations[joint] * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5)
        + span_s * span_s * after.accelerations[joint] * (0.5 * s3 - s4 + 0.5 * s5)
    )
