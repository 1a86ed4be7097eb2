"""Moments and ranges that pages print, by hand: steps of a packet, begins of faults, simulated time, extremes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cellc.contract.attempt import AttemptRecord, MadeStep, PacketStep, TracePoint
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent
from cellc.mock.evidence.envelope import Envelope
from cellc.mock.evidence.fault_times import fault_times
from cellc.mock.result import RehearsalResult, simulated_s
from tests.mock.conftest import Written

MS = 1_000_000


@pytest.fixture
def plain(written: Written) -> RehearsalResult:
    return written.results["pick_and_place"]


def attempt(record: AttemptRecord, started_ms: int, **steps_ms: int) -> AttemptRecord:
    points = tuple(TracePoint(PacketStep[step], at_ms * MS) for step, at_ms in steps_ms.items())
    return replace(record, started_ns=started_ms * MS, trace=points)


def test_a_step_is_counted_from_the_latest_before_it(plain: RehearsalResult) -> None:
    record = attempt(plain.attempts[0], 1000, DRIVEN=1300, OBSERVED=960, PLANNED=1250)
    assert record.made == {
        PacketStep.OBSERVED: MadeStep(960 * MS, -0.04),  # 960 - 1000: older than the attempt
        PacketStep.PLANNED: MadeStep(1250 * MS, 0.25),  # 1250 - 1000, not 1250 - 960
        PacketStep.DRIVEN: MadeStep(1300 * MS, 0.05),  # 1300 - 1250
    }
    assert list(record.made) == [PacketStep.OBSERVED, PacketStep.PLANNED, PacketStep.DRIVEN]


def test_simulated_time_is_that_of_all(plain: RehearsalResult) -> None:
    assert simulated_s([replace(plain, sim_time_s=1.5), replace(plain, sim_time_s=2.25)]) == 3.75
    assert simulated_s([]) == 0.0


@pytest.mark.parametrize(
    ("at_s", "event", "start_s"),
    [
        (0.5, None, 2.5),  # the last record begins at 2 s, with the first step
        (None, FaultEvent(step=1, when="started", after_s=0.1), 2.1),  # 2 + 0.1
        (None, FaultEvent(step=2, when="accepted", after_s=0.2), 3.6),  # 3.4 + 0.2
        (None, FaultEvent(step=2, when="moving"), 3.5),
        (None, FaultEvent(step=1, when="moving"), None),  # it never moved
        (None, FaultEvent(step=3, when="started"), None),  # of two steps
    ],
)
def test_a_fault_begins_with_what_it_waits_for(
    plain: RehearsalResult, at_s: float | None, event: FaultEvent | None, start_s: float | None
) -> None:
    of = plain.attempts[0]
    attempts = [attempt(of, 2000), attempt(of, 3000, ACCEPTED=3400, DRIVEN=3500), attempt(of, 2000)]
    fault = FaultEntry.model_construct(kind=next(iter(FaultKind)), target="x", at_s=at_s, event=event)
    assert [at for at, _ in fault_times([fault], attempts)] == ([] if start_s is None else [pytest.approx(start_s)])
    assert fault_times([fault], []) == ()


def test_faults_are_in_the_order_of_their_begin(plain: RehearsalResult) -> None:
    faults = [FaultEntry.model_construct(kind=next(iter(FaultKind)), target="x", at_s=at, event=None) for at in (3, 1)]
    assert [at for at, _ in fault_times(faults, [attempt(plain.attempts[0], 500)])] == [1.5, 3.5]


def test_extremes_are_of_all_slots_that_have_a_value() -> None:
    slots = np.arange(3, dtype=np.int64)
    lowest, highest = np.array([[0.5], [np.nan], [-0.25]]), np.array([[0.75], [np.nan], [0.6]])
    assert Envelope(1, slots, lowest, highest).extremes == (-0.25, 0.75)
    assert Envelope(1, slots, lowest * np.nan, highest * np.nan).extremes == (0.0, 0.0)
