"""The rehearsals of the real cell, and every fault, end in their named outcome."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cellc.contract.attempt import AttemptRecord
from cellc.contract.steps import StepKind
from cellc.mock import MockCell
from cellc.mock.task.task import EXECUTED
from tests.mock.conftest import Fault, LoadWith, fault


def last_attempt(cell: MockCell) -> AttemptRecord:
    """Return the attempt that ended the rehearsal, before the record that sums up."""
    return cell.run("faulty").attempts[-2]


def test_pick_and_place_succeeds_step_by_step(cell: MockCell) -> None:
    result = cell.run("pick_and_place")
    assert result.passed
    assert [attempt.step for attempt in result.attempts] == [
        "move home",
        "detect object",
        "move pick",
        "grip close gripper",
        "move place",
        "grip open gripper",
        "move home",
        "end",
    ]


def test_frozen_camera_ends_in_stale_state_when_the_last_observation_is_as_old_as_the_contract_allows(
    cell: MockCell,
) -> None:
    result = cell.run("stale_camera")
    assert result.passed
    failed = result.attempts[-2]
    assert failed.fault_code.startswith("newest observation of object is 0.200 s old")
    assert failed.cancel is not None
    assert failed.cancel.held_ns is not None


def test_cancel_holds_within_its_bound(cell: MockCell) -> None:
    result = cell.run("canceled")
    assert result.passed
    cancel = result.attempts[-2].cancel
    assert cancel is not None
    assert cancel.latency_s is not None
    assert cancel.latency_s <= 0.2


def test_a_bound_that_is_not_held_fails_the_rehearsal(load_with: LoadWith) -> None:
    cell = load_with(fault("cancel", "move", 3.0), expect="canceled", within_s=0.001)
    result = cell.run("faulty")
    assert result.outcome == "canceled"
    assert not result.passed


def test_grip_has_the_timeout_of_its_own_action(edit_contract: Callable[[Callable[[Any], None]], MockCell]) -> None:
    def state_timeout(contract: Any) -> None:
        contract["interfaces"]["/gripper_action/gripper_cmd"]["timeout_s"] = 0.001

    failed = edit_contract(state_timeout).run("pick_and_place").attempts[-2]
    assert (failed.step, failed.outcome) == ("grip close gripper", "timeout")
    assert failed.fault_code == "no result from gripper_action within 0.001 s"


CASES: list[tuple[str, Fault, str, str]] = [
    ("observed frame no longer published", fault("drop_frame", "object", 0.0), "tf_failure", "into the future"),
    ("link no longer published", fault("drop_frame", "arm_forearm_link", 0.02), "tf_failure", "into the future"),
    ("camera frozen from the start", fault("freeze", "camera", 0.0), "stale_state", "observation of object"),
    ("joint states late", fault("delay", "arm", 1.0, delay_s=0.3), "stale_state", "joint state is"),
    ("broadcaster inactive", fault("reject", "joint_states", 1.0), "stale_state", "joint state is"),
    ("goal out of reach", fault("unreachable", "pick", 0.0), "planning_failure", "no_ik_solution"),
    ("controller inactive", fault("reject", "arm_trajectory", 1.0), "goal_rejection", "not running"),
    ("stuck joint", fault("stick", "arm_elbow_joint", 0.5), "tolerance_violation", "path tolerance violation"),
    ("missed cycles", fault("skip_cycles", "", 1.0, cycles=5), "missed_cycle", "update cycles missed, 0 allowed"),
    ("update loop stops", fault("skip_cycles", "", 1.0, cycles=100_000), "missed_cycle", "cycles missed"),
    (
        "protective stop",
        fault("protective_stop", "arm", 1.0),
        "protective_stop",
        "arm_hardware reports protective_stop",
    ),
    ("canceled grip", fault("cancel", "grip", 1.0), "canceled", "the grip was canceled as requested"),
]


@pytest.mark.parametrize(("entry", "outcome", "reason"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_fault_ends_in_its_own_outcome(load_with: LoadWith, entry: Fault, outcome: str, reason: str) -> None:
    failed = last_attempt(load_with(entry))
    assert failed.outcome == outcome
    assert reason in failed.fault_code


def test_gripper_that_sticks_is_noticed_although_its_controller_calls_the_stall_a_success(load_with: LoadWith) -> None:
    failed = last_attempt(load_with(fault("stick", "gripper_robotiq_85_left_knuckle_joint", 0.5)))
    assert failed.result is not None
    assert failed.result.status == "succeeded"
    assert failed.outcome == "tolerance_violation"


def test_protective_stop_outranks_a_stale_observation(load_with: LoadWith) -> None:
    failed = last_attempt(load_with(fault("freeze", "camera", 1.0), fault("protective_stop", "arm", 1.05)))
    assert failed.outcome == "protective_stop"
    assert failed.safety_state == "protective_stop"
    assert failed.operator_intervention == "required: acknowledge by operator"


def test_rehearsal_that_takes_too_long_is_canceled_and_held(load_with: LoadWith) -> None:
    failed = last_attempt(load_with(timeout_s=1.0))
    assert failed.outcome == "timeout"
    assert failed.cancel is not None
    assert failed.cancel.held_ns is not None


def test_fault_that_ends_before_it_is_met_changes_nothing(load_with: LoadWith) -> None:
    # Frozen from 0 to 20 ms: the next image comes before the newest observation is 200 ms old.
    cell = load_with(fault("freeze", "camera", 0.0, lasting_s=0.02))
    assert cell.run("faulty").outcome == "succeeded"


def test_two_controller_managers_share_one_clock(two_managers: MockCell) -> None:
    own = [entry for entry in two_managers.entries if entry.bring_up == "mock"]  # only that plan is for two managers
    outcomes = [two_managers.run(entry.name).outcome for entry in own]
    assert outcomes == [
        "succeeded",
        "stale_state",
        "claim_failure",
        "succeeded",
        "succeeded",
        "canceled",
        *["grip_failure"] * 4,
    ]


def test_every_kind_of_step_is_executed() -> None:
    assert set(EXECUTED) == set(StepKind)
