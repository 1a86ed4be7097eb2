"""Every fault that the cell can meet, at every step of its rehearsal: the named outcome, within the bound."""

from __future__ import annotations

from collections import Counter

import pytest

from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.mock import MockCell
from cellc.mock.faults.case import BORNE, FaultCase, ends_in
from cellc.mock.faults.possible import possible_faults
from tests.mock.faults.conftest import Rehearse


def test_every_fault_at_the_start_of_every_step_ends_as_its_case_says(
    cell: MockCell, plain: RehearsalEntry, run: Rehearse
) -> None:
    wrong = []
    for case in possible_faults(cell.contract):
        for step in range(1, len(plain.steps) + 1):
            result = run(case.at(step)).result
            within_s = case.within_s(plain.steps, step)
            late = result.outcome != "succeeded" and within_s is not None and (result.response_s or 0.0) > within_s
            if result.outcome not in case.outcomes(plain.steps, step) or late:
                wrong.append(f"{case.name} at step {step}: {result.outcome} after {result.response_s} s")
    assert wrong == []


def test_names_of_cases_are_unique(cell: MockCell) -> None:
    assert set(Counter(case.name for case in possible_faults(cell.contract)).values()) == {1}


@pytest.mark.parametrize(("first", "outcomes"), [(1, {"stale_state"}), (3, {"stale_state"}), (4, {"succeeded"})])
def test_outcomes_of_a_run_are_those_of_the_steps_up_to_the_first_that_cannot_bear_the_fault(
    first: int, outcomes: set[str]
) -> None:
    entry = FaultEntry(kind="freeze", target="camera")
    look = StepEntry(kind="detect", target="part")
    wait = StepEntry(kind="wait", target="")
    case = FaultCase(entry, {("detect", "part"): ends_in("stale_state", within_s=1.0), ("wait", ""): BORNE})
    steps = (wait, wait, look, wait)
    assert case.outcomes(steps, first) == outcomes


def test_bound_of_a_run_is_the_longest_of_the_steps_that_it_may_end_in() -> None:
    entry = FaultEntry(kind="stick", target="joint")
    endings = {
        ("move", "a"): ends_in("tolerance_violation", "succeeded", within_s=2.0),
        ("move", "b"): ends_in("tolerance_violation", within_s=5.0),
        ("move", "c"): ends_in("tolerance_violation", within_s=9.0),
    }
    steps = tuple(StepEntry(kind="move", target=name) for name in "abc")
    assert FaultCase(entry, endings).within_s(steps, 1) == 5.0


@pytest.mark.parametrize("when", ["started", "accepted", "moving"])
def test_fault_begins_with_its_event(cell: MockCell, run: Rehearse, when: str) -> None:
    entry = FaultEntry(kind="protective_stop", target="arm", event=FaultEvent(step=3, when=when))
    failed = run(entry).failed
    assert (failed.step, failed.outcome) == ("move pick", "protective_stop")
    marks = {point.step.name for point in failed.trace}
    assert marks >= {"started": set(), "accepted": {"ACCEPTED"}, "moving": {"ACCEPTED", "DRIVEN"}}[when]
    assert ("ACCEPTED" in marks) == (when != "started")
    assert ("DRIVEN" in marks) == (when == "moving")


def test_offset_of_an_event_is_kept_to_the_nanosecond(run: Rehearse) -> None:
    without = run(FaultEntry(kind="protective_stop", target="arm", event=FaultEvent(step=3, when="moving")))
    entry = FaultEntry(kind="protective_stop", target="arm", event=FaultEvent(step=3, when="moving", after_s=0.1))
    later = run(entry)
    assert later.result.sim_time_s - without.result.sim_time_s == pytest.approx(
        0.1, abs=0.05
    )  # ends on a tick of the monitor


def test_event_that_never_comes_injects_nothing(run: Rehearse) -> None:
    result = run(FaultEntry(kind="protective_stop", target="arm", event=FaultEvent(step=2, when="accepted"))).result
    assert (result.outcome, result.response_s) == ("succeeded", None)
