"""Bounds on what a controller commands when it interpolates between points by quintics."""

from __future__ import annotations

from functools import cache
from math import comb

import numpy as np

from cellc.planning.limits import Array

_DEGREE = 5


def quintic_coefficients(durations: Array, states: tuple[Array, Array, Array]) -> Array:
    """Return the quintics between consecutive points, as the trajectory controller builds them.

    Args:
        durations: seconds between points, shape (points - 1,).
        states: positions, velocities and accelerations, each of shape (points, joints).

    Returns:
        Coefficients of rising powers of the time scaled to 0..1, shape (points - 1, 6, joints).
    """
    time = durations[:, np.newaxis]
    position, speed, bend = states[0], states[1], states[2]
    first, last = position[:-1], position[1:]
    speed_first, speed_last = speed[:-1] * time, speed[1:] * time
    bend_first, bend_last = bend[:-1] * time**2, bend[1:] * time**2
    # What the end still lacks after position, velocity and acceleration of the start are carried on.
    lack = last - first - speed_first - bend_first / 2.0
    lack_speed = speed_last - speed_first - bend_first
    lack_bend = bend_last - bend_first
    return np.stack(
        (
            first,
            speed_first,
            bend_first / 2.0,
            10.0 * lack - 4.0 * lack_speed + lack_bend / 2.0,
            -15.0 * lack + 7.0 * lack_speed - lack_bend,
            6.0 * lack - 3.0 * lack_speed + lack_bend / 2.0,
        ),
        axis=1,
    )


def extremes(coefficients: Array, durations: Array, order: int) -> tuple[Array, Array]:
    """Bound a derivative of all quintics from below and above by the hull of its Bernstein coefficients.

    The bound is never too narrow; it is exact where the derivative is monotone, so for every piece of constant jerk.

    Args:
        order: 0 position, 1 velocity, 2 acceleration, 3 jerk.

    Returns:
        Least and greatest value over all pieces, each of shape (joints,), in units of seconds.
    """
    powers = coefficients
    for _ in range(order):
        powers = powers[:, 1:, :] * np.arange(1, powers.shape[1])[np.newaxis, :, np.newaxis]
    powers = powers / (durations[:, np.newaxis, np.newaxis] ** order)
    control = np.einsum("ij,kjl->kil", _to_bernstein(_DEGREE - order), powers)
    flat = control.reshape(-1, control.shape[2])
    return flat.min(axis=0), flat.max(axis=0)


@cache
def _to_bernstein(degree: int) -> Array:
    rows = [[comb(row, power) / comb(degree, power) for power in range(degree + 1)] for row in range(degree + 1)]
    return np.array(rows)
