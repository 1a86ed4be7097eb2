"""A robot whose program stops, is jogged and starts again: nothing jumps where a watch lets go of the claim.

How the robot behaves is ur_client_library 2.14.0, resources/external_control.urscript: a set point that asks for more
than 20 rad/s in a step of 2 ms, 0.04 rad, is ignored with a popup, and one that is closer is followed at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from typing import Any

import pytest

from cellc.contract.bring_up import Watch
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry
from cellc.contract.vocabulary import AttemptOutcome, BringUpPhase, Need
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from cellc.mock.faults.registry import possible_faults
from cellc.mock.plant import Plant
from tests.cells import ROOT
from tests.mock.faults.conftest import ACKNOWLEDGE, HOME, Rehearse, Run, during, wait

WRIST = "arm_wrist_3_joint"
STOPPED = (HOME, wait(5.0), HOME)
CLAIMED_AGAIN = (HOME, wait(5.0), ACKNOWLEDGE, HOME)


def moment(kind: FaultKind, target: str, after_s: float, **more: Any) -> FaultEntry:
    """Return a fault that begins so long after the second step has."""
    return FaultEntry(kind=kind, target=target, event=FaultEvent(step=2, after_s=after_s), **more)


def jogged_and_started(distance: float) -> tuple[FaultEntry, ...]:
    """Return a stop of the program, a jog of the wrist, and the start of the program two seconds later."""
    return (
        moment(FaultKind.PROGRAM_STOP, "arm", 0.5),
        moment(FaultKind.JOG, WRIST, 1.0, displacement=distance),
        moment(FaultKind.PROGRAM_START, "arm", 2.5),
    )


Unwatched = Callable[..., Run]


@pytest.fixture(scope="module")
def unwatched(cell: MockCell, plain: RehearsalEntry) -> Unwatched:
    """Run rehearsals of the same cell, from whose plan the watch of the claims is taken away."""
    without = cell_of(replace(cell.folder, watches=()))

    def rehearse(*faults: FaultEntry, **changes: Any) -> Run:
        plants: list[Plant] = []
        entry = plain.model_copy(update={"name": "unwatched", "faults": faults, **changes})
        return Run(without.rehearse(entry, watch=plants.append), plants[0])

    return rehearse


def test_claim_goes_when_the_program_stops_in_motion_and_the_arm_stands(run: Rehearse) -> None:
    done = run(during(3, FaultKind.PROGRAM_STOP, "arm"))
    assert done.failed.outcome == "claim_failure"
    assert done.failed.fault_code == "arm_trajectory gave up its claim: the program of arm is not running"
    assert done.failed.operator_intervention == "required: program start, then a claim, by operator"
    assert done.travel(done.plant.now_ns - 10_000_000, done.plant.now_ns) == 0.0


def test_arm_that_was_jogged_moves_on_from_where_it_stands_once_a_person_claims_it_again(run: Rehearse) -> None:
    done = run(*jogged_and_started(radians(1.5)), steps=CLAIMED_AGAIN)
    assert [record.outcome for record in done.result.attempts] == [
        "succeeded",
        "claim_failure",
        "succeeded",
        "succeeded",
        "succeeded",
    ]
    # the wrist was really jogged by 1.5 deg, and at its 0.25 rad/s no cycle of 2 ms moved it by more than 0.01 rad
    assert done.travel(done.result.attempts[1].started_ns, done.result.attempts[2].ended_ns) == pytest.approx(
        radians(1.5), abs=1e-6
    )
    assert done.plant.effects.motions == []


def test_without_a_watch_the_arm_jumps_to_the_set_point_that_was_kept_and_the_run_fails_with_figures(
    unwatched: Unwatched,
) -> None:
    done = unwatched(*jogged_and_started(radians(1.5)), steps=STOPPED)
    assert done.result.outcome == "uncommanded_motion"
    assert not done.result.passed
    (motion,) = done.plant.effects.motions
    assert motion.joint == WRIST
    assert motion.step == pytest.approx(0.02618, abs=1e-5)  # 1.5 deg in one cycle
    assert motion.cycle * 2_000_000 == motion.stamp_ns
    assert done.failed.fault_code == (
        f"arm_wrist_3_joint moved 0.0262 of 0.0262 rad in cycle {motion.cycle} ({motion.stamp_ns / 1e9:.3f} s): "
        "arm_trajectory kept its set point while the program of arm was stopped"
    )


def test_set_point_beyond_what_the_robot_follows_in_a_step_is_ignored_and_that_fails_too(unwatched: Unwatched) -> None:
    done = unwatched(*jogged_and_started(0.05), steps=STOPPED)
    assert done.failed.outcome == "claim_failure"
    assert done.failed.fault_code.startswith(
        "arm ignores a set point 0.0500 rad away from arm_wrist_3_joint, it follows at most 0.04"
    )
    assert done.plant.effects.motions == []


def test_watch_that_listens_to_another_topic_prevents_no_jump(cell: MockCell, plain: RehearsalEntry) -> None:
    (watch,) = cell.folder.watches
    elsewhere = watch.while_hold[Need.PROGRAM_RUNNING].model_copy(update={"topic": "/arm_i/robot_program_running"})
    deaf: tuple[Watch, ...] = (watch.model_copy(update={"while_hold": {Need.PROGRAM_RUNNING: elsewhere}}),)
    entry = plain.model_copy(update={"faults": jogged_and_started(radians(1.5)), "steps": STOPPED})
    result = cell_of(replace(cell.folder, watches=deaf)).rehearse(entry)
    assert result.outcome == "uncommanded_motion"


def test_campaign_has_the_fault_for_the_arm_and_fails_without_a_watch(cell: MockCell, unwatched: Unwatched) -> None:
    (case,) = [case for case in possible_faults(cell.contract) if case.entry.kind is FaultKind.STALE_SET_POINTS]
    assert case.entry.target == "arm"
    done = unwatched(case.at(2), steps=(HOME, wait(1.0), HOME))
    assert done.result.outcome == "uncommanded_motion"
    assert done.result.outcome not in case.outcomes((HOME, wait(1.0), HOME), 2)


def test_a_response_is_counted_from_what_began_before_the_attempt_ended(run: Rehearse) -> None:
    # The claim goes 0.1 s or so after the program stops; jog and start come later, and ended nothing.
    assert 0.0 < (run(*jogged_and_started(0.0), steps=CLAIMED_AGAIN).result.response_s or 0.0) < 0.5


def test_jog_while_the_program_runs_moves_nothing_and_the_rehearsal_shows_nothing(run: Rehearse) -> None:
    done = run(moment(FaultKind.JOG, WRIST, 0.5, displacement=0.02), steps=(HOME, wait(1.0)))
    assert done.result.findings[-1] == (
        f"fault `jog {WRIST}` never began: the program of arm is running, so its pendant moves nothing"
    )
    assert not done.result.passed


def test_program_that_is_stopped_stands_for_ever_and_nobody_can_claim_it(run: Rehearse) -> None:
    done = run(moment(FaultKind.PROGRAM_STOP, "arm", 0.5), steps=CLAIMED_AGAIN)
    assert done.result.outcome == "claim_failure"
    assert done.attempt(3).fault_code == "arm still follows no set points 120 s after a claim request"


def test_brakes_of_a_robot_with_a_program_stop_that_program_too(run: Rehearse) -> None:
    closed = moment(FaultKind.BRAKES_CLOSED, "arm", 0.5, lasting_s=1.0)
    assert run(closed, steps=STOPPED).result.outcome == "claim_failure"
    assert run(closed, steps=CLAIMED_AGAIN).result.outcome == "succeeded"


def test_fault_of_a_phase_begins_before_anything_of_it_is_asked_for(run: Rehearse) -> None:
    done = run(FaultEntry(kind=FaultKind.PROGRAM_STOP, target="arm", phase=BringUpPhase.CLAIM), steps=(HOME,))
    assert done.result.response_s is not None


def test_a_robot_without_a_program_gives_its_claim_up_as_its_own_fault_comes() -> None:
    # ros2_kortex 945324f, hardware_interface.cpp:793: while a fault lasts nothing is sent, and controllers stay active.
    cell = load(ROOT / "generated/gen3_2f")
    entry = FaultEntry(kind=FaultKind.STALE_SET_POINTS, target="arm", event=FaultEvent(step=2, when="moving"))
    changes = {"faults": (entry,), "expect": AttemptOutcome.CLAIM_FAILURE}
    result = cell.rehearse(cell.entry("rack_to_washer").model_copy(update=changes))
    assert result.passed
    assert "arm_trajectory gave up its claim: arm follows no set points" in result.reason
