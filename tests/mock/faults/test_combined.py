"""Several faults in one run, at times and events, end in one named outcome; the same run again gives the same bytes."""

from __future__ import annotations

from itertools import pairwise

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell
from cellc.mock.faults.registry import possible_faults
from cellc.mock.result import to_json_lines
from tests.mock.faults.conftest import ACKNOWLEDGE, DETECT, HOME, PICK, Rehearse, during, wait

NAMED = set(AttemptOutcome)


def test_neighbours_of_the_list_of_faults_end_together_in_a_named_outcome_of_either(
    cell: MockCell, plain: RehearsalEntry, run: Rehearse
) -> None:
    wrong = []
    for first, second in pairwise(possible_faults(cell.contract)):
        done = run(first.at(3), second.at(3, "moving", 0.1))
        allowed = first.outcomes(plain.steps, 3) | second.outcomes(plain.steps, 3, "moving")
        if done.result.outcome not in allowed:
            wrong.append(f"{first.name} and {second.name}: {done.result.outcome}, not in {sorted(allowed)}")
    assert wrong == []


@pytest.mark.parametrize(
    ("faults", "outcome"),
    [
        (
            (during(3, FaultKind.FREEZE, "camera"), during(3, FaultKind.PROTECTIVE_STOP, "arm", after_s=0.35)),
            "protective_stop",
        ),
        ((during(3, FaultKind.FREEZE, "arm"), during(3, FaultKind.CANCEL, "move")), "canceled"),
        ((during(3, FaultKind.SKIP_CYCLES, cycles=5), during(3, FaultKind.RESTART_DRIVER, "arm")), "hardware_fault"),
        (
            (during(3, FaultKind.UNRESPONSIVE, "arm_trajectory"), during(3, FaultKind.RESTART_DRIVER, "arm")),
            "hardware_fault",
        ),
        (
            (during(3, FaultKind.SECOND_COMMANDER, "arm_trajectory"), during(3, FaultKind.FREEZE, "camera")),
            "wrong_owner",
        ),
    ],
)
def test_the_graver_or_the_earlier_of_two_faults_names_the_outcome(
    run: Rehearse, faults: tuple[FaultEntry, ...], outcome: str
) -> None:
    assert run(*faults).failed.outcome == outcome


def test_faults_at_a_time_and_with_an_event_go_together(run: Rehearse) -> None:
    # Steps 1 and 2 take 0.1 s; the plan of step 3 is executed from 0.15 s on.
    at_time = FaultEntry(kind="freeze", target="camera", at_s=0.3)
    assert run(at_time, during(3, FaultKind.CANCEL, "move", after_s=0.05)).failed.outcome == "canceled"
    assert run(at_time, during(3, FaultKind.CANCEL, "move", after_s=1.0)).failed.outcome == "stale_state"


@pytest.mark.parametrize(
    "kinds", [("protective_stop", "emergency_stop"), ("emergency_stop", "protective_stop")], ids=["worse", "better"]
)
def test_two_stops_of_one_device_are_acknowledged_when_both_are_over(
    run: Rehearse, kinds: tuple[FaultKind, FaultKind]
) -> None:
    faults = (during(3, kinds[0], "arm", lasting_s=0.5), during(3, kinds[1], "arm", lasting_s=3.0))
    done = run(*faults, steps=(HOME, DETECT, PICK, ACKNOWLEDGE, wait(0.1), HOME))
    acknowledged = done.attempt(4)
    assert (done.attempt(3).safety_state, done.result.outcome) == ("emergency_stop", "succeeded")
    assert (acknowledged.ended_ns - acknowledged.started_ns) / 1e9 == pytest.approx(3.0, abs=0.3)


def test_second_stop_while_one_is_acknowledged_keeps_the_cell_stopped(run: Rehearse) -> None:
    second = during(5, FaultKind.EMERGENCY_STOP, "arm", when="started", after_s=0.05)
    steps = (HOME, DETECT, PICK, wait(2.0), ACKNOWLEDGE, HOME)
    done = run(during(3, FaultKind.PROTECTIVE_STOP, "arm", lasting_s=1.0), second, steps=steps)
    # It is heard when the claims are there again, after the acknowledgment, and the next step meets it.
    assert (done.attempt(5).outcome, done.attempt(6).outcome) == ("succeeded", "emergency_stop")
    assert done.result.outcome == "emergency_stop"


def test_a_fault_gives_the_same_records_twice(cell: MockCell, run: Rehearse) -> None:
    # Every third, which is prime to how they are listed; campaigns compare the digests of all of them.
    for case in possible_faults(cell.contract)[::3]:
        first, second = (run(case.at(3, "moving", 0.1)).result for _ in range(2))
        assert to_json_lines(first.attempts) == to_json_lines(second.attempts), case.name
        assert first == second, case.name
        assert first.outcome in NAMED
