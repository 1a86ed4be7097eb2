"""Limiting a whole column gives bit by bit what limiting its values one after the other gives."""

from __future__ import annotations

import numpy as np

from cellc.mock.control.hardware.joint_motion import rate_limit
from tests.properties import given, st

_VALUES = st.lists(st.floats(-4.0, 4.0), min_size=1, max_size=60)
_HELD = st.lists(st.tuples(st.floats(-4.0, 4.0), st.integers(1, 40)), min_size=1, max_size=6)


def _one_by_one(values: list[float], previous: float, step: float, lower: float, upper: float) -> list[float]:
    """The rule in words: not further than a step from the last, and inside the bounds, the bounds winning."""
    limited = []
    for value in values:
        low = max(min(previous - step, upper), lower)
        high = min(max(previous + step, low), upper)
        low, high = min(low, high), max(low, high)
        previous = low if value < low else high if value > high else value
        limited.append(previous)
    return limited


def _agree(values: list[float], previous: float, step: float, lower: float, upper: float) -> None:
    found, first = rate_limit(np.array(values), previous, step, lower, upper)
    expected = _one_by_one(values, previous, step, lower, upper)
    assert found.tolist() == expected
    differing = [index for index, value in enumerate(values) if value != expected[index]]
    assert first <= (differing[0] if differing else len(values))


@given(_VALUES, st.floats(-3.0, 3.0), st.floats(0.0, 1.0))
def test_any_values_are_limited_alike(values: list[float], previous: float, step: float) -> None:
    _agree(values, previous, step, -2.5, 3.0)


@given(_HELD, st.floats(-3.0, 3.0), st.floats(0.001, 0.4))
def test_steps_and_ramps_are_limited_alike(held: list[tuple[float, int]], previous: float, step: float) -> None:
    _agree([value for value, count in held for _ in range(count)], previous, step, -2.5, 3.0)


@given(_HELD, st.floats(-3.0, 3.0), st.floats(0.001, 0.4))
def test_unbounded_values_are_limited_alike(held: list[tuple[float, int]], previous: float, step: float) -> None:
    _agree([value for value, count in held for _ in range(count)], previous, step, -np.inf, np.inf)
