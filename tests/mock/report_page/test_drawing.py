"""Envelopes and curves: no extreme value is lost, however long the run and however narrow the drawing."""

from __future__ import annotations

import re

import numpy as np
import pytest

from cellc.mock.evidence.envelope import Envelope, EnvelopeBuilder
from cellc.mock.report_page.axes import Scale, path, ticks
from tests.properties import given, settings, st

SAMPLES = st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=400)


def built(times_ns: np.ndarray, values: np.ndarray) -> Envelope:
    builder = EnvelopeBuilder(1)
    for start in range(0, len(times_ns), 50):
        builder.add(times_ns[start : start + 50], values[start : start + 50, None])
    return builder.envelope()


@settings(max_examples=50)
@given(SAMPLES, st.integers(1_000_000, 60_000_000_000))
def test_extremes_survive_any_length_of_a_run(values: list[float], spacing_ns: int) -> None:
    times = np.arange(len(values), dtype=np.int64) * spacing_ns
    envelope = built(times, np.array(values))
    assert envelope.lowest.min() == min(values)
    assert envelope.highest.max() == max(values)
    for start_ns, low, high in zip(envelope.starts_ns, envelope.lowest[:, 0], envelope.highest[:, 0], strict=True):
        inside = np.array(values)[(times >= start_ns) & (times < start_ns + envelope.width_ns)]
        assert (low, high) == (inside.min(), inside.max())


def test_memory_of_an_envelope_does_not_grow_with_the_run() -> None:
    builder = EnvelopeBuilder(1)
    for hour in range(3):
        times = hour * 3_600_000_000_000 + np.arange(1000, dtype=np.int64) * 3_600_000_000
        builder.add(times, np.zeros((1000, 1)))
    assert len(builder.envelope().starts_ns) <= 1024


@settings(max_examples=50)
@given(SAMPLES)
def test_curve_reaches_the_extreme_rows(values: list[float]) -> None:
    times = np.arange(len(values), dtype=np.int64) * 10_000_000
    # Few columns, so that many samples share one.
    x, y = Scale(0.0, max(len(values) * 0.01, 0.01), 0.0, 7.0), Scale(-5.0, 5.0, 100.0, 0.0)
    drawn = path(built(times, np.array(values)), x, y)
    rows = [float(row) for row in re.findall(r"(?:[ML]-?\d+ |V)(-?[\d.]+)", drawn)]
    assert min(rows) == round(y.place(max(values)), 1)
    assert max(rows) == round(y.place(min(values)), 1)


def test_one_wrong_sample_among_thousands_is_drawn() -> None:
    values = np.zeros(30_000)
    values[17_321] = 1.0
    envelope = built(np.arange(30_000, dtype=np.int64) * 2_000_000, values)
    drawn = path(envelope, Scale(0.0, 60.0, 0.0, 350.0), Scale(0.0, 1.0, 100.0, 0.0))
    assert " 0.0" in drawn or "V0.0" in drawn


def test_curve_is_broken_where_nothing_was_sampled() -> None:
    times = np.concatenate([np.arange(10), 500 + np.arange(10)]).astype(np.int64) * 10_000_000
    drawn = path(built(times, np.zeros(20)), Scale(0.0, 6.0, 0.0, 600.0), Scale(-1.0, 1.0, 100.0, 0.0))
    assert drawn.count("M") == 2


def test_ticks_are_round_values_inside_the_range() -> None:
    assert ticks(-0.61, 0.0, 4) == pytest.approx([-0.6, -0.4, -0.2, 0.0])
    assert ticks(0.0, 9.95, 6) == pytest.approx([0.0, 2.0, 4.0, 6.0, 8.0])


def test_rounding_of_a_range_takes_no_tick_away() -> None:
    # 0.6000000000000001 / 6 is a hair above 0.1, and 7 ticks of 0.1 fit.
    assert ticks(0.0, 0.1 * 6, 6) == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
