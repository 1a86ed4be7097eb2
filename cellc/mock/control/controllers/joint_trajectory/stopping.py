"""The trajectory that stops the joints with constant deceleration (`constraints.decelerate_on_cancel`)."""

from __future__ import annotations

import math

import numpy as np

from cellc.mock.control.interfaces import Array
from cellc.mock.control.messages import TrajectoryPoint


def stop_points(position: Array, velocity: Array, deceleration: Array, period_ns: int) -> tuple[TrajectoryPoint, ...]:
    """Points of a stop from a measured state, one per period.

    Args:
        position: measured positions.
        velocity: measured velocities.
        deceleration: magnitude of each joint's deceleration, > 0.
        period_ns: period of the controller.

    Returns:
        Points with positions, velocities and accelerations, from the present state to rest of the last joint.
    """
    stop_s = np.abs(velocity) / deceleration
    count = math.ceil(float(stop_s.max()) * 1e9 / period_ns) + 1
    rest = position + velocity * np.abs(velocity) / (2.0 * deceleration)
    points = []
    for index in range(count + 1):
        time_s = index * period_ns / 1e9
        moving = time_s < stop_s
        acceleration = np.where(moving, -np.sign(velocity) * deceleration, 0.0)
        way = position + velocity * time_s + 0.5 * acceleration * time_s * time_s
        points.append(
            TrajectoryPoint(
                tuple(np.where(moving, way, rest).tolist()),
                tuple(np.where(moving, velocity + acceleration * time_s, 0.0).tolist()),
                tuple(acceleration.tolist()),
                time_from_start_ns=index * period_ns,
            )
        )
    return tuple(points)
