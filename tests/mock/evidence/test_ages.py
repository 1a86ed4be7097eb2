"""The age of a stream: rising between arrivals, overtaken messages and those that never came included."""

from __future__ import annotations

import pytest

from cellc.mock.clocks import Clock, Segment
from cellc.mock.evidence.envelope import AgeBuilder, AgeTrace

MS = 1_000_000


def followed(*sent: tuple[int, int], until_ms: int) -> AgeTrace:
    """Follow messages given as (arrival, stamp) in ms on a perfect clock."""
    builder = AgeBuilder("states", "task", Clock("sim", "sim", (Segment(0, 0, 1.0),)), 0.1)
    for arrives_ms, stamp_ms in sent:
        builder.sent(arrives_ms * MS, stamp_ms * MS)
    builder.advance(until_ms * MS)
    return builder.trace()


def test_age_rises_until_the_next_message_arrives() -> None:
    trace = followed((20, 0), (120, 100), until_ms=150)
    assert trace.worst_s == pytest.approx(0.120)  # the first one, just before the second arrives
    highest = trace.envelope.highest[:, 0].tolist()
    starts = [start / MS for start in trace.envelope.starts_ns.tolist()]
    assert starts == list(range(20, 160, 10))
    assert highest[starts.index(70)] == pytest.approx(0.070)


def test_message_that_arrives_after_the_end_makes_nothing_younger() -> None:
    assert followed((10, 10), (400, 50), until_ms=300).worst_s == pytest.approx(0.290)


def test_overtaken_message_makes_nothing_older() -> None:
    trace = followed((90, 10), (60, 50), until_ms=100)
    assert trace.worst_s == pytest.approx(0.050)


def test_nothing_that_arrives_has_no_age() -> None:
    assert followed(until_ms=100).worst_s is None
