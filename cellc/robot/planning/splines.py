"""The curve of a path section over its parameter, and bounds on the quintics that a controller makes of it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import comb

import numpy as np

from cellc.robot.planning.problem import Array

_DEGREE = 5


class SectionCurve:
    """Maps a parameter from 0 to 1 to a configuration; waypoint ``i`` of ``n`` lies at ``i / (n - 1)``.

    The ends are not-a-knot: the first two pieces share one cubic, as do the last two, because nothing is known of the
    curvature there.
    """

    def __init__(self, waypoints: Sequence[Sequence[float]]) -> None:
        """Fit the curve through two or more waypoints."""
        self._values: Array = np.array(waypoints, dtype=np.float64)
        self._width = 1.0 / (len(waypoints) - 1)
        self._second = _second_derivatives(self._values, self._width)

    @property
    def inner_knots(self) -> tuple[float, ...]:
        """Parameters of the inner waypoints, where the third derivative jumps."""
        pieces = len(self._values) - 1
        return tuple(knot / pieces for knot in range(1, pieces))

    def derivatives(self, parameters: Array) -> tuple[Array, Array, Array, Array]:
        """Return value and first three derivatives by the parameter, each of shape (parameters, joints)."""
        width = self._width
        piece = np.clip((parameters / width).astype(np.intp), 0, len(self._values) - 2)
        along = (parameters / width - piece)[:, np.newaxis]
        left, right = 1.0 - along, along
        first, last = self._values[piece], self._values[piece + 1]
        bend_first, bend_last = self._second[piece], self._second[piece + 1]
        value = left * first + right * last
        value = value + width**2 / 6.0 * ((left**3 - left) * bend_first + (right**3 - right) * bend_last)
        slope = (last - first) / width
        slope = slope + width / 6.0 * ((3.0 * right**2 - 1.0) * bend_last - (3.0 * left**2 - 1.0) * bend_first)
        return value, slope, left * bend_first + right * bend_last, (bend_last - bend_first) / width

    def steepest(self) -> tuple[Array, Array, Array]:
        """Return per joint the largest absolute first, second and third derivative, sampled at and between knots."""
        samples = np.linspace(0.0, 1.0, 4 * (len(self._values) - 1) + 1)
        _, first, second, third = (np.max(np.abs(values), axis=0) for values in self.derivatives(samples))
        return first, second, third


def _second_derivatives(values: Array, width: float) -> Array:
    count = len(values)
    second: Array = np.zeros_like(values)
    if count == 2:
        return second
    bends = (values[:-2] - 2.0 * values[1:-1] + values[2:]) / width**2
    if count == 3:
        second[:] = bends[0]
        return second
    # The ends continue the line through their two neighbors, which makes the second and the last but one known. The
    # rest by elimination in a fixed order: a library solver differs in its last bits from processor to processor.
    second[1], second[-2] = bends[0], bends[-1]
    right_side = 6.0 * bends[1:-1]
    right_side[:1] -= second[1]
    right_side[-1:] -= second[-2]
    second[2:-2] = _eliminated(right_side)
    second[0], second[-1] = 2.0 * second[1] - second[2], 2.0 * second[-2] - second[-3]
    return second


def _eliminated(right_side: Array) -> Array:
    """Solve the system with 4 on the diagonal and 1 beside it, one column a joint (Thomas)."""
    solution: Array = right_side.copy()
    pivots = [4.0]
    for row in range(1, len(solution)):
        solution[row] -= solution[row - 1] / pivots[-1]
        pivots.append(4.0 - 1.0 / pivots[-1])
    for row in reversed(range(len(solution))):
        if row + 1 < len(solution):
            solution[row] -= solution[row + 1]
        solution[row] /= pivots[row]
    return solution


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
