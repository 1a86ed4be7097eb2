"""The trajectory controller's quintic, built in the test from its six end conditions by a linear solve."""

from __future__ import annotations

from math import perm

import numpy as np
import numpy.typing as npt

from cellc.robot.planning import TimedTrajectory

Array = npt.NDArray[np.float64]


def derivatives_between(trajectory: TimedTrajectory, samples_per_piece: int) -> tuple[Array, list[Array]]:
    """Return sample times in seconds and position, velocity, acceleration, jerk of shape (samples, joints)."""
    times: list[Array] = []
    orders: list[list[Array]] = [[], [], [], []]
    for first, last in zip(trajectory.points[:-1], trajectory.points[1:], strict=True):
        duration = (last.time_from_start_ns - first.time_from_start_ns) * 1e-9
        ends = [first.positions, first.velocities, first.accelerations]
        ends += [last.positions, last.velocities, last.accelerations]
        scale = np.array([1.0, duration, duration**2, 1.0, duration, duration**2])[:, np.newaxis]
        rows = [_row(0.0, order) for order in range(3)] + [_row(1.0, order) for order in range(3)]
        coefficients = np.linalg.solve(np.array(rows), np.array(ends) * scale)
        fractions = np.linspace(0.0, 1.0, samples_per_piece)
        times.append(first.time_from_start_ns * 1e-9 + fractions * duration)
        for order in range(4):
            basis = np.array([_row(fraction, order) for fraction in fractions])
            orders[order].append(basis @ coefficients / duration**order)
    return np.concatenate(times), [np.concatenate(parts) for parts in orders]


def _row(at: float, order: int) -> list[float]:
    """Return the derivatives of the powers 0 to 5 at a place."""
    return [perm(power, order) * at ** (power - order) if power >= order else 0.0 for power in range(6)]
