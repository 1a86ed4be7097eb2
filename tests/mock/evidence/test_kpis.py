"""The key figures of the checkpoint, from records and changes whose figures are known by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cellc.contract.attempt import AttemptRecord, CancelRecord, PacketStep, TracePoint
from cellc.contract.entities import Kpis
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.evidence.kpis import Kpi, kpis
from cellc.mock.evidence.run_trace import Claim, StateChange, TraceResult
from cellc.mock.result import RehearsalResult
from tests.mock.conftest import Written

TARGETS = Kpis(
    plan_to_execute_s=0.5,
    cancel_s=0.2,
    missed_cycles=0,
    stale_state_rejection=1.0,
    protective_stops=0,
    recovery_time_s=2.0,
    wrong_owner_events=0,
)
QUIET = TraceResult(joints=(), states=(), ages=(), claims=(), changes=(), missed_cycles=0, ended_ns=0)
MS = 1_000_000


@pytest.fixture
def plain(written: Written) -> RehearsalResult:
    return written.results["pick_and_place"]


def figures(result: RehearsalResult, *attempts: AttemptRecord, trace: TraceResult = QUIET) -> dict[str, Kpi]:
    changed = replace(result, attempts=attempts or result.attempts)
    return {figure.name: figure for figure in kpis(TARGETS, changed, trace, max_state_age_s=0.1)}


def marked(record: AttemptRecord, planned_ms: int, driven_ms: int) -> AttemptRecord:
    points = (TracePoint(PacketStep.PLANNED, planned_ms * MS), TracePoint(PacketStep.DRIVEN, driven_ms * MS))
    return replace(record, trace=points)


def test_longest_time_from_plan_to_motion_counts(plain: RehearsalResult) -> None:
    record = plain.attempts[0]
    found = figures(plain, marked(record, 100, 350), marked(record, 1000, 1600), marked(record, 0, 1))
    assert (found["plan_to_execute_s"].value, found["plan_to_execute_s"].met) == (0.6, False)


def test_cancel_that_never_held_misses_the_target_without_a_value(plain: RehearsalResult) -> None:
    record = marked(plain.attempts[0], 0, 1)
    held = replace(record, cancel=CancelRecord(0, 50 * MS, 0.05, 0))
    never = replace(record, cancel=CancelRecord(0, None, None, 0))
    assert figures(plain, held)["cancel_s"].value == 0.05
    assert figures(plain, held)["cancel_s"].met is True
    assert (figures(plain, held, never)["cancel_s"].value, figures(plain, held, never)["cancel_s"].met) == (None, False)


def test_share_of_stale_data_that_was_rejected(plain: RehearsalResult) -> None:
    record = plain.attempts[0]
    rejected = replace(record, outcome=AttemptOutcome.STALE_STATE, trace=())
    used = replace(marked(record, 0, 1), joint_state_age=0.3, action_goal_id="a")
    assert figures(plain, rejected)["stale_state_rejection"].value == 1.0
    assert figures(plain, rejected, used)["stale_state_rejection"].value == 0.5
    assert figures(plain, rejected, used)["stale_state_rejection"].met is False
    assert figures(plain)["stale_state_rejection"].value is None


def test_stops_and_recovery_are_taken_from_the_changes_of_hardware(plain: RehearsalResult) -> None:
    changes = (
        StateChange(1000 * MS, "hardware component", "arm", "inactive", ""),
        StateChange(1000 * MS, "controller", "arm_trajectory", "inactive", ""),
        StateChange(4000 * MS, "hardware component", "arm", "active", ""),
    )
    found = figures(plain, trace=replace(QUIET, changes=changes))
    assert (found["protective_stops"].value, found["protective_stops"].met) == (1, False)
    assert (found["recovery_time_s"].value, found["recovery_time_s"].met) == (3.0, False)


def test_claim_of_a_controller_that_the_contract_does_not_name_is_a_wrong_owner(plain: RehearsalResult) -> None:
    claims = (Claim("j/position", "arm", 0, 1, True), Claim("j/position", "other", 1, 2, False))
    found = figures(plain, trace=replace(QUIET, claims=claims))
    assert (found["wrong_owner_events"].value, found["wrong_owner_events"].met) == (1, False)


def test_attempt_that_another_commander_ended_is_a_wrong_owner(plain: RehearsalResult) -> None:
    ended = replace(plain.attempts[0], outcome=AttemptOutcome.WRONG_OWNER)
    assert figures(plain, ended)["wrong_owner_events"].value == 1


def test_real_run_meets_what_it_came_to(plain: RehearsalResult) -> None:
    found = figures(plain)
    assert found["plan_to_execute_s"].met is True
    assert found["recovery_time_s"].value is None
    assert found["recovery_time_s"].met is None
