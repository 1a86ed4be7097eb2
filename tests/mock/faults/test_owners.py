"""A command that leaves its declared owner is noticed, ends in its own outcome and is counted."""

from __future__ import annotations

import pytest

from cellc.contract.faults import FaultKind
from cellc.mock.faults.goals import CLIENT
from tests.mock.faults.conftest import DETECT, HOME, PICK, Rehearse, during, wait


def test_goal_that_another_client_replaces_ends_as_wrong_owner(run: Rehearse) -> None:
    failed = run(during(3, FaultKind.SECOND_COMMANDER, "arm_trajectory")).failed
    assert failed.outcome == "wrong_owner"
    assert failed.result is not None
    # The table of facts, row "new accepted goal while one runs", in the words of Jazzy.
    assert (failed.result.error_code, failed.result.error_string) == (
        -1,
        "Current goal preempted by new incoming action.",
    )


def test_second_commander_is_noticed_while_nothing_of_the_task_executes(run: Rehearse) -> None:
    steps = (HOME, DETECT, wait(2.0), PICK)
    done = run(during(3, FaultKind.SECOND_COMMANDER, "arm_trajectory", when="started"), steps=steps)
    assert (done.failed.step, done.failed.outcome) == ("wait", "wrong_owner")
    assert done.failed.fault_code == f"{CLIENT} sent a goal to arm_trajectory"


def test_wrong_owner_events_are_counted(run: Rehearse) -> None:
    faults = [during(3, FaultKind.SECOND_COMMANDER, name) for name in ("arm_trajectory", "gripper_action")]
    assert len(run(*faults).plant.task.actions.foreign) == 2


def test_goals_of_both_clients_are_canceled_and_the_arm_is_held(run: Rehearse) -> None:
    done = run(during(3, FaultKind.SECOND_COMMANDER, "arm_trajectory"))
    assert done.failed.cancel is not None
    assert done.failed.cancel.held_ns is not None
    assert done.failed.cancel.latency_s is not None
    assert done.failed.cancel.latency_s <= 0.2
    # The other client's goal takes a second: it would still be executing.
    assert done.plant.control.managers["control"].cancel_all("arm_trajectory").goals_canceling == ()


def test_goal_of_a_second_client_that_is_rejected_commands_nothing(run: Rehearse) -> None:
    # An inactive controller rejects every goal (table of facts, acceptance, row 1): the task's own is rejected too.
    faults = [during(2, FaultKind.REJECT, "arm_trajectory", when="started", after_s=0.0)]
    faults.append(during(3, FaultKind.SECOND_COMMANDER, "arm_trajectory", when="started", after_s=0.0))
    done = run(*faults)
    assert (done.failed.outcome, len(done.plant.task.actions.foreign)) == ("goal_rejection", 0)


def test_controller_switched_in_motion_ends_as_wrong_owner_and_leaves_the_last_command(run: Rehearse) -> None:
    done = run(during(3, FaultKind.SWITCH, "arm_trajectory"))
    assert done.failed.outcome == "wrong_owner"
    assert done.failed.result is not None
    assert done.failed.result.error_string == "Current goal cancelled during deactivate transition."
    assert done.travel(done.failed.ended_ns - 40_000_000, done.failed.ended_ns) == 0.0


@pytest.mark.parametrize("step", [4, 6])
def test_gripper_controller_switched_in_motion_never_sends_a_result_and_nobody_waits_for_it(
    run: Rehearse, step: int
) -> None:
    done = run(during(step, FaultKind.SWITCH, "gripper_action", after_s=0.0))
    assert done.failed.outcome == "wrong_owner"
    assert done.failed.result is None
    assert done.result.response_s is not None
    assert done.result.response_s < 0.5


def test_controller_restarted_between_two_goals_takes_the_next_one(run: Rehearse) -> None:
    assert run(during(2, FaultKind.SWITCH, "arm_trajectory", when="started", after_s=0.0)).result.outcome == "succeeded"
