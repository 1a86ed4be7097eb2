"""Rate limiting of a whole column at once, bit-identical to limiting it value by value."""

from __future__ import annotations

import numpy as np

from cellc.mock.control.interfaces import Array

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
