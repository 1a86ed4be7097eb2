"""How simulated joints follow their commands: their states, a ramp with bounded speed, and noise."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
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


# A column that changes between free and limited more often than this is limited value by value.
_MAX_SWITCHES = 8


def clamp(value: float, lower: float, upper: float) -> float:
    """Clamp as std::clamp does: NaN passes."""
    if value < lower:
        return lower
    return upper if upper < value else value


def step_bounds(previous: float, step: float, lower: float, upper: float) -> tuple[float, float]:
    """Bounds of the next value: at most `step` from the previous one, inside [lower, upper]."""
    low = max(min(previous - step, upper), lower)
    high = min(max(previous + step, low), upper)
    return (low, high) if low <= high else (high, low)


def rate_limit(values: Array, previous: float, step: float, lower: float, upper: float) -> tuple[Array, int]:
    """Limit the change from value to value and the value itself.

    Args:
        values: wanted values of successive cycles, without NaN.
        previous: the limited value before the first.
        step: largest change in one cycle.
        lower: lower bound of the value.
        upper: upper bound of the value.

    Returns:
        The limited values, and the index of the first that differs from the wanted one (the length if none does).
    """
    first = _first_limited(values, previous, step, lower, upper)
    if first == len(values):
        return values, first
    limited = values.copy()
    start, before = first, float(values[first - 1]) if first else previous
    for _ in range(_MAX_SWITCHES):
        start = _follow_ramp(limited, start, before, step, lower, upper)
        if start == len(values):
            return limited, first
        before = float(limited[start - 1])
        start += _first_limited(limited[start:], before, step, lower, upper)
        if start == len(values):
            return limited, first
        before = float(limited[start - 1])
    for index in range(start, len(values)):
        before = clamp(float(limited[index]), *step_bounds(before, step, lower, upper))
        limited[index] = before
    return limited, first


def _first_limited(values: Array, previous: float, step: float, lower: float, upper: float) -> int:
    """Index of the first value that would be limited if none before it was."""
    before = np.empty_like(values)
    before[0] = previous
    before[1:] = values[:-1]
    low = np.maximum(np.minimum(before - step, upper), lower)
    high = np.minimum(np.maximum(before + step, low), upper)
    violated = (values < low) | (values > high)
    index = int(violated.argmax())
    return index if violated[index] else len(values)


def _follow_ramp(values: Array, start: int, before: float, step: float, lower: float, upper: float) -> int:
    """Write the limited values in place from `start` on while they stay limited; return where they become free."""
    low, high = step_bounds(before, step, lower, upper)
    rising = values[start] > high
    ramp = np.empty(len(values) - start + 1)
    ramp[0], ramp[1:] = before, step if rising else -step
    np.add.accumulate(ramp, out=ramp)
    # Repeated addition and repeated clamping agree as long as the ramp is inside the bounds.
    ramp = np.minimum(ramp[1:], upper) if rising else np.maximum(ramp[1:], lower)
    wanted = values[start:]
    free = (wanted <= ramp) if rising else (wanted >= ramp)
    free |= (ramp < lower) | (ramp > upper)
    index = int(free.argmax())
    length = index if free[index] else len(wanted)
    if length == 0:
        values[start] = clamp(float(values[start]), low, high)
        return start + 1
    values[start : start + length] = ramp[:length]
    return start + length


# Steps and multipliers of SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014), whose
# n-th value needs none of those before it.
_STEP = np.uint64(0x9E3779B97F4A7C15)
_MIX = (np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB))


@dataclass(frozen=True, slots=True)
class Noise:
    """Evenly distributed noise of one joint.

    Attributes:
        amplitude: rad or m; no value is farther from zero.
        key: of the sequence.
    """

    amplitude: float
    key: int

    @classmethod
    def of_joint(cls, joint: str, amplitude: float, seed: int) -> Noise:
        """Return the noise of a joint in a run with a seed."""
        digest = hashlib.sha256(f"{seed}/{joint}".encode()).digest()
        return cls(amplitude, int.from_bytes(digest[:8], "big"))

    def values(self, first: int, count: int) -> Array:
        """Return the values of ``count`` update cycles, of which ``first`` is the number of the first one."""
        state = (np.arange(first + 1, first + count + 1, dtype=np.uint64) * _STEP) + np.uint64(self.key)
        state = (state ^ (state >> np.uint64(30))) * _MIX[0]
        state = (state ^ (state >> np.uint64(27))) * _MIX[1]
        state ^= state >> np.uint64(31)
        unit: Array = (state >> np.uint64(11)).astype(np.float64) * 2.0**-53
        return (2.0 * unit - 1.0) * self.amplitude
