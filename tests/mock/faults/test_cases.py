"""Every fault that the cell can meet, at steps of its rehearsal: the named outcome, within the bound.

Each fault is tried at every fourth step, its neighbours at the others; `cellc campaign` tries them all.
"""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell, load
from cellc.mock.errors import MockError
from cellc.mock.faults.cases import BORNE, CellStep, FaultCase, ends_in
from cellc.mock.faults.endings import Bounds
from cellc.mock.faults.registry import possible_faults
from tests.cells import ROOT
from tests.mock.faults.conftest import Rehearse


def test_every_fault_at_the_start_of_a_step_ends_as_its_case_says(
    cell: MockCell, plain: RehearsalEntry, run: Rehearse
) -> None:
    wrong = []
    for number, case in enumerate(possible_faults(cell.contract)):
        step = 1 + number % len(plain.steps)
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
    look = StepEntry(kind=StepKind.DETECT, target="part")
    wait = StepEntry(kind=StepKind.WAIT, target="")
    case = FaultCase(
        entry, {("detect", "part"): ends_in(AttemptOutcome.STALE_STATE, within_s=1.0), ("wait", ""): BORNE}
    )
    steps = (wait, wait, look, wait)
    assert case.outcomes(steps, first) == outcomes


def test_bound_of_a_run_is_the_longest_of_the_steps_that_it_may_end_in() -> None:
    entry = FaultEntry(kind="stick", target="joint")
    endings = {
        ("move", "a"): ends_in(AttemptOutcome.TOLERANCE_VIOLATION, AttemptOutcome.SUCCEEDED, within_s=2.0),
        ("move", "b"): ends_in(AttemptOutcome.TOLERANCE_VIOLATION, within_s=5.0),
        ("move", "c"): ends_in(AttemptOutcome.TOLERANCE_VIOLATION, within_s=9.0),
    }
    steps = tuple(StepEntry(kind=StepKind.MOVE, target=name) for name in "abc")
    assert FaultCase(entry, endings).within_s(steps, 1) == 5.0


@pytest.mark.parametrize("when", ["started", "accepted", "moving"])
def test_fault_begins_with_its_event(cell: MockCell, run: Rehearse, when: str) -> None:
    entry = FaultEntry(kind="restart_driver", target="arm", event=FaultEvent(step=3, when=when))
    failed = run(entry).failed
    assert (failed.step, failed.outcome) == ("move pick", "hardware_fault")
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


def test_event_that_never_comes_injects_nothing_and_that_is_told(run: Rehearse) -> None:
    result = run(FaultEntry(kind="protective_stop", target="arm", event=FaultEvent(step=2, when="accepted"))).result
    assert (result.outcome, result.response_s) == ("succeeded", None)
    assert result.findings[-1] == (
        "fault `protective_stop arm` never began: step 2 was never `accepted`, or was over too soon"
    )


def test_time_after_the_end_injects_nothing_and_that_is_told(run: Rehearse) -> None:
    result = run(FaultEntry(kind="protective_stop", target="arm", at_s=100.0)).result
    assert result.findings[-1] == "fault `protective_stop arm` never began: the rehearsal was over before 100 s"
    assert result.outcome == result.expected
    assert not result.passed  # it shows nothing about the fault that it is for


@pytest.mark.parametrize("moment", [{}, {"at_s": 1.0, "event": FaultEvent(step=1)}])
def test_fault_begins_at_a_time_or_with_an_event(run: Rehearse, moment: dict[str, Any]) -> None:
    with pytest.raises(MockError, match="needs either a time or an event"):
        run(FaultEntry(kind="protective_stop", target="arm", **moment))


@pytest.mark.parametrize(
    ("kind", "target"),
    [
        ("freeze", "lamp"),
        ("double_frame", "world"),
        ("jump_clock", "moon"),
        ("mismatch_qos", "/nothing"),
        ("unresponsive", "nobody"),
        ("second_commander", "joint_states"),
        ("switch", "to_nowhere"),
        ("slow", "knee"),
        ("scale_speed", "gripper"),
        ("wrong_payload", "gripper"),
        ("emergency_stop", "camera"),
        ("cut_network", "fixture"),
    ],
)
def test_fault_that_names_what_the_contract_does_not_have_is_refused(
    run: Rehearse, kind: FaultKind, target: str
) -> None:
    with pytest.raises(MockError, match=f"fault `{kind}` names `{target}`"):
        run(FaultEntry(kind=kind, target=target, at_s=1.0))


def test_refusal_of_a_group_that_moves_after_another_may_come_after_its_motion() -> None:
    bounds = Bounds(load(ROOT / "generated" / "dual_ur").contract)
    alone = CellStep("move", "home", ("loader_trajectory",))
    in_turn = CellStep("move", "home", ("loader_trajectory", "unloader_trajectory"))
    # Each goal of an arm may take what the action that plans and executes allows.
    (allowed_s,) = {
        interface.timeout_s
        for interface in bounds.contract.interfaces.values()
        if interface.type == "moveit_msgs/action/MoveGroup"
    }
    assert allowed_s is not None
    assert bounds.refused_s(alone) == bounds.asked_s()
    assert bounds.refused_s(in_turn) == pytest.approx(bounds.asked_s() + 2 * allowed_s)
