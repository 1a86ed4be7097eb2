"""Sampling of a trajectory at many times together.

The kind of a segment follows from what both of its ends give: positions alone are joined by lines, with velocities by
cubics, with accelerations too by quintics. Accelerations without velocities give zero throughout: a defect of the real
controller that is kept on purpose.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.mock.control.interfaces import Array, Times
from cellc.mock.control.messages import TrajectoryPoint

Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class StartState:
    """The state from which a trajectory starts; None where a field is unknown."""

    time_ns: int
    position: Array
    velocity: Array | None
    acceleration: Array | None


@dataclass(slots=True)
class _Knots:
    """Start state and points as arrays of one row each; what was not given is zero and flagged."""

    times_ns: Times
    position: Array
    velocity: Array
    acceleration: Array
    has_position: NDArray[np.bool_]
    has_velocity: NDArray[np.bool_]
    has_acceleration: NDArray[np.bool_]


def _fill(rows: Sequence[Sequence[float]], joints: int) -> tuple[Array, NDArray[np.bool_]]:
    given = np.array([len(row) > 0 for row in rows])
    if given.all() and {len(row) for row in rows} == {joints}:
        return np.array(rows, dtype=float), given
    values = np.zeros((len(rows), joints))
    for index, row in enumerate(rows):
        if len(row):
            values[index] = row[:joints]
    return values, given


def _knots(start: StartState, points: Sequence[TrajectoryPoint], start_ns: int) -> _Knots:
    joints = len(start.position)
    # A field that the first point gives and the start state lacks counts as zero, so that both are of one kind.
    zero = [0.0] * joints
    velocity = start.velocity if start.velocity is not None else (zero if points[0].velocities else ())
    acceleration = start.acceleration if start.acceleration is not None else (zero if points[0].accelerations else ())
    times = [start.time_ns, *(start_ns + point.time_from_start_ns for point in points)]
    positions = _fill([start.position.tolist(), *(point.positions for point in points)], joints)
    velocities = _fill([list(velocity), *(point.velocities for point in points)], joints)
    accelerations = _fill([list(acceleration), *(point.accelerations for point in points)], joints)
    return _Knots(
        np.array(times, dtype=np.int64),
        positions[0],
        velocities[0],
        accelerations[0],
        positions[1],
        velocities[1],
        accelerations[1],
    )


def _integrate(knots: _Knots) -> None:
    """Fill in positions, and velocities, that follow from derivatives (trapezoidal, point by point)."""
    for index in range(1, len(knots.times_ns)):
        if knots.has_position[index]:
            continue
        before = index - 1
        duration_s = (knots.times_ns[index] - knots.times_ns[before]) / 1e9
        knots.has_velocity[before] = True
        if not knots.has_velocity[index]:
            knots.has_acceleration[before] = True
            rates = (knots.acceleration[before] + knots.acceleration[index]) * 0.5
            knots.velocity[index] = knots.velocity[before] + rates * duration_s
            knots.has_velocity[index] = True
        mean = (knots.velocity[before] + knots.velocity[index]) * 0.5
        knots.position[index] = knots.position[before] + mean * duration_s
        knots.has_position[index] = True


def _coefficients(knots: _Knots) -> list[Array]:
    """Polynomial coefficients of each segment, by power; the last row is the last point, standing."""
    rows, joints = knots.position.shape
    table = [np.zeros((rows, joints)) for _ in range(6)]
    a, b = knots.position[:-1], knots.position[1:]
    velocity = knots.has_velocity[:-1] & knots.has_velocity[1:]
    acceleration = knots.has_acceleration[:-1] & knots.has_acceleration[1:]
    span = (knots.times_ns[1:] - knots.times_ns[:-1]) / 1e9
    # No time lies inside a segment without length; its coefficients are never used.
    t = np.where(span == 0.0, 1.0, span)[:, None]
    linear, cubic, quintic = ~velocity & ~acceleration, velocity & ~acceleration, velocity & acceleration
    for kind in (linear, cubic, quintic):
        table[0][:-1][kind] = a[kind]
    table[1][:-1][linear] = ((b - a) / t)[linear]
    _cubic(table, knots, cubic, t)
    _quintic(table, knots, quintic, t)
    table[0][-1] = knots.position[-1]
    table[1][-1] = knots.velocity[-1]
    table[2][-1] = knots.acceleration[-1] / 2.0
    return table


def _cubic(table: list[Array], knots: _Knots, rows: NDArray[np.bool_], span: Array) -> None:
    if not rows.any():
        return
    a, b, t = knots.position[:-1][rows], knots.position[1:][rows], span[rows]
    va, vb = knots.velocity[:-1][rows], knots.velocity[1:][rows]
    table[1][:-1][rows] = va
    table[2][:-1][rows] = (-3.0 * a + 3.0 * b - 2.0 * va * t - vb * t) / (t * t)
    table[3][:-1][rows] = (2.0 * a - 2.0 * b + va * t + vb * t) / (t * t * t)


def _quintic(table: list[Array], knots: _Knots, rows: NDArray[np.bool_], span: Array) -> None:
    if not rows.any():
        return
    a, b, t = knots.position[:-1][rows], knots.position[1:][rows], span[rows]
    va, vb = knots.velocity[:-1][rows] * t, knots.velocity[1:][rows] * t
    t2 = t * t
    ca, cb = knots.acceleration[:-1][rows] * t2, knots.acceleration[1:][rows] * t2
    table[1][:-1][rows] = knots.velocity[:-1][rows]
    table[2][:-1][rows] = 0.5 * knots.acceleration[:-1][rows]
    table[3][:-1][rows] = (-20.0 * a + 20.0 * b - 3.0 * ca + cb - 12.0 * va - 8.0 * vb) / (2.0 * t2 * t)
    table[4][:-1][rows] = (30.0 * a - 30.0 * b + 3.0 * ca - 2.0 * cb + 16.0 * va + 14.0 * vb) / (2.0 * t2 * t2)
    table[5][:-1][rows] = (-12.0 * a + 12.0 * b - ca + cb - 6.0 * va - 6.0 * vb) / (2.0 * t2 * t2 * t)


def _steps(knots: _Knots) -> list[Array]:
    """Without interpolation: ahead of the first point the start state, later always the next point."""
    order = [0, *range(2, len(knots.times_ns)), len(knots.times_ns) - 1]
    table = [knots.position[order], knots.velocity[order], knots.acceleration[order] / 2.0]
    return [*table, *(np.zeros_like(table[0]) for _ in range(3))]


class Spline:
    """A trajectory with its start, ready to be sampled.

    Args:
        start: the state from which it starts.
        points: its points, each in the order of the joints.
        start_ns: the time from which `time_from_start` counts.
        interpolate: false for the interpolation method `none`.
    """

    def __init__(self, start: StartState, points: Sequence[TrajectoryPoint], start_ns: int, interpolate: bool) -> None:
        knots = _knots(start, points, start_ns)
        _integrate(knots)
        self.start_ns = start_ns
        self.before_ns = start.time_ns
        self.point_times_ns: Times = knots.times_ns[1:]
        self.count = len(points)
        self._bases = knots.times_ns.copy()
        self._interpolate = interpolate
        self._table = _coefficients(knots) if interpolate else _steps(knots)
        self._degree = max([power for power in range(6) if self._table[power].any()], default=0)

    def locate(self, times_ns: Times) -> tuple[Indices, Array]:
        """Find the segments of times.

        Returns:
            For each time the number of points that are reached (the number of all points at the end), and the time into
            the segment in seconds.
        """
        indices = self.point_times_ns.searchsorted(times_ns, side="right")
        if not self._interpolate:
            return indices, np.zeros(len(times_ns))
        into = (times_ns - self._bases[indices]) / 1e9
        if indices[-1] == self.count:
            into[indices == self.count] = 0.0
        return indices, into

    def _rows(self, power: int, indices: Indices) -> Array:
        table = self._table[power]
        # One row is broadcast, which spares gathering it for each cycle.
        return table[indices[0]] if indices[0] == indices[-1] else table[indices]

    def _evaluate(self, indices: Indices, into: Array, factors: tuple[float, ...], shift: int) -> Array:
        if not self._interpolate:
            return self._table[shift][indices] * factors[shift]
        t = into[:, None]
        value = np.zeros((len(into), self._table[0].shape[1]))
        # Trajectories with NaN or infinity are accepted by the real controller too.
        with np.errstate(invalid="ignore", over="ignore"):
            for power in range(self._degree, shift - 1, -1):
                value *= t
                row, factor = self._rows(power, indices), factors[power]
                value += row if factor == 1.0 else row * factor
        if indices[-1] == self.count:
            # The last point itself, whatever its derivatives are: NaN * 0 would spread.
            value[indices == self.count] = self._table[shift][-1] * factors[shift]
        return value

    def last_point(self) -> TrajectoryPoint:
        """The last point, due immediately, with its velocity and acceleration."""
        position, velocity, half = (self._table[power][-1].tolist() for power in range(3))
        return TrajectoryPoint(tuple(position), tuple(velocity), tuple(2.0 * value for value in half))

    def positions(self, indices: Indices, into: Array) -> Array:
        """Positions at located times, shape (times, joints)."""
        return self._evaluate(indices, into, (1.0, 1.0, 1.0, 1.0, 1.0, 1.0), 0)

    def velocities(self, indices: Indices, into: Array) -> Array:
        """Velocities at located times."""
        return self._evaluate(indices, into, (0.0, 1.0, 2.0, 3.0, 4.0, 5.0), 1)

    def accelerations(self, indices: Indices, into: Array) -> Array:
        """Accelerations at located times."""
        return self._evaluate(indices, into, (0.0, 0.0, 2.0, 6.0, 12.0, 20.0), 2)
