"""Time parameterisation: jerk-limited motion along a path, as points for the trajectory controller.

Each section is run from rest to rest by one motion law of its parameter, so that all joints keep to the path exactly.
Points lie at every instant at which the jerk changes. On a straight edge each joint's position is one cubic between two
such points, and the controller's quintic through position, velocity and acceleration is that cubic itself.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cellc.planning.limits import JointLimits
from cellc.planning.path import JointPath
from cellc.planning.section import TimedSection, time_at_rest, time_moving
from cellc.planning.trajectory import LimitUse, TimedTrajectory, TrajectoryPoint, measure_use


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
        elif any(waypoint != waypoints[0] for waypoint in waypoints):
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
