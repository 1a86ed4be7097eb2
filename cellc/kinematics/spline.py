"""The curve of one path section over its parameter: a line, or the C2 cubic spline through its waypoints."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cellc.kinematics.limits import Array


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
    system = np.zeros((count, count))
    system[0, :3] = system[-1, -3:] = (1.0, -2.0, 1.0)
    inner = np.arange(1, count - 1)
    system[inner, inner - 1] = system[inner, inner + 1] = 1.0
    system[inner, inner] = 4.0
    right_side = np.vstack((second[:1], 6.0 * bends, second[:1]))
    return np.asarray(np.linalg.solve(system, right_side))
