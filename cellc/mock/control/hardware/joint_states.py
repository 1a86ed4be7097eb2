"""Positions, velocities and accelerations of the joints of one component, advanced by whole blocks of cycles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellc.mock.control.interfaces import Array


@dataclass(slots=True)
class Motion:
    """Values of all joints over successive cycles, each of shape (cycles, joints)."""

    position: Array
    velocity: Array
    acceleration: Array

    @staticmethod
    def standing(cycles: int, position: Array, velocity: Array, acceleration: Array) -> Motion:
        """Every joint keeps its values."""
        return Motion(_repeat(position, cycles), _repeat(velocity, cycles), _repeat(acceleration, cycles))


def _repeat(row: Array, cycles: int) -> Array:
    rows = np.empty((cycles, len(row)))
    rows[:] = row
    return rows


def differences(values: Array, previous: Array, period_s: float) -> Array:
    """Difference quotients of successive rows, the first against `previous`."""
    out = np.empty_like(values)
    np.subtract(values[0], previous, out=out[0])
    np.subtract(values[1:], values[:-1], out=out[1:])
    out /= period_s
    return out


def integral(rates: Array, previous: Array, period_s: float) -> Array:
    """Sums of rate * period, row by row, starting from `previous`."""
    out = np.empty((len(rates) + 1, rates.shape[1]))
    out[0] = previous
    np.multiply(rates, period_s, out=out[1:])
    np.add.accumulate(out, axis=0, out=out)
    return out[1:]


def hold_last(values: Array, previous: Array) -> Array:
    """Replace NaN by the last number of the same column, at the top by `previous`."""
    missing = np.isnan(values)
    if not missing.any():
        return values
    rows: NDArray[np.intp] = np.where(missing, 0, np.arange(1, len(values) + 1)[:, None])
    np.maximum.accumulate(rows, axis=0, out=rows)
    stacked = np.vstack([previous, values])
    return np.take_along_axis(stacked, rows, axis=0)
