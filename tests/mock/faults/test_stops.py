"""A stop ends whatever runs, holds the arm, and lasts until an operator acknowledges; nothing is asked twice."""

from __future__ import annotations

import pytest

from cellc.contract.faults import FaultKind
from cellc.mock import MockCell
from cellc.mock.control import ControllerManager
from tests.mock.faults.conftest import ACKNOWLEDGE, DETECT, HOME, PICK, Rehearse, during, wait

STOPS: tuple[tuple[FaultKind, str, str], ...] = (
    (FaultKind.PROTECTIVE_STOP, "protective_stop", "protective_stop"),
    (FaultKind.EMERGENCY_STOP, "emergency_stop", "emergency_stop"),
    (FaultKind.RESTART_DRIVER, "hardware_fault", "fault"),
    (FaultKind.WRONG_PAYLOAD, "protective_stop", "protective_stop"),
)
RECOVERY = (HOME, DETECT, PICK, wait(2.0), ACKNOWLEDGE, wait(0.5), HOME)


@pytest.mark.parametrize(("kind", "outcome", "state"), STOPS)
def test_stop_has_its_own_outcome_and_names_who_has_to_acknowledge(
    run: Rehearse, kind: FaultKind, outcome: str, state: str
) -> None:
    failed = run(during(3, kind, "arm")).failed
    assert (failed.step, failed.outcome, failed.safety_state) == ("move pick", outcome, state)
    assert failed.operator_intervention == "required: acknowledge by operator"


@pytest.mark.parametrize(("kind", "outcome", "state"), STOPS)
def test_every_goal_after_a_stop_is_refused_with_a_record_until_it_is_acknowledged(
    run: Rehearse, kind: FaultKind, outcome: str, state: str
) -> None:
    steps = (HOME, DETECT, PICK, wait(2.0), HOME, PICK, ACKNOWLEDGE)
    done = run(during(3, kind, "arm", lasting_s=1.0), steps=steps)
    refused = [done.attempt(number) for number in (5, 6)]
    assert [record.outcome for record in refused] == [outcome, outcome]
    assert [record.action_goal_id for record in refused] == [None, None]
    assert done.travel(done.attempt(4).started_ns, done.attempt(7).started_ns) == 0.0


@pytest.mark.parametrize(("kind", "outcome", "state"), STOPS)
def test_nothing_moves_after_the_reconnect_before_a_new_goal_is_sent(
    run: Rehearse, kind: FaultKind, outcome: str, state: str
) -> None:
    # The goal of step 3 was running when the device stopped; a replay would drive the arm from where it stands.
    done = run(during(3, kind, "arm", lasting_s=1.0), steps=RECOVERY)
    waited, acknowledged, rested, home = (done.attempt(number) for number in (4, 5, 6, 7))
    assert done.travel(waited.started_ns, rested.ended_ns) < 1e-9
    assert acknowledged.operator_intervention == "acknowledged by operator"
    assert (home.outcome, done.result.outcome) == ("succeeded", "succeeded")
    assert done.travel(home.started_ns, home.ended_ns) > 0.01


def test_reconnect_alone_leaves_the_arm_stopped(run: Rehearse) -> None:
    done = run(during(3, FaultKind.RESTART_DRIVER, "arm", lasting_s=0.2), steps=(HOME, DETECT, PICK, wait(5.0), HOME))
    assert done.result.outcome == "hardware_fault"
    assert done.plant.stops.state() == "fault"


def test_driver_that_comes_back_has_its_controllers_inactive(run: Rehearse) -> None:
    done = run(during(3, FaultKind.RESTART_DRIVER, "arm", lasting_s=0.2))
    manager: ControllerManager = done.plant.control.managers["control"]
    states = {controller.name: controller.state for controller in manager.list_controllers()}
    assert (states["arm_trajectory"], states["gripper_action"]) == ("inactive", "active")
    result = done.failed.result
    assert result is not None
    # The table of facts, row "controller deactivated": aborted with -1 and this text.
    assert (result.error_code, result.error_string) == (-1, "Current goal cancelled during deactivate transition.")


def test_stop_that_goes_on_cannot_be_acknowledged_and_that_is_bounded(run: Rehearse, cell: MockCell) -> None:
    done = run(during(3, FaultKind.EMERGENCY_STOP, "arm"), steps=RECOVERY)
    refused = done.attempt(5)
    assert (refused.outcome, done.result.outcome) == ("emergency_stop", "emergency_stop")
    assert (refused.ended_ns - refused.started_ns) / 1e9 == cell.contract.kpis.recovery_time_s
    assert refused.operator_intervention == "required: acknowledge by operator"


def test_wrong_payload_stops_the_arm_again_after_every_acknowledgment(run: Rehearse) -> None:
    done = run(during(3, FaultKind.WRONG_PAYLOAD, "arm"), steps=(*RECOVERY, ACKNOWLEDGE, HOME))
    assert [record.outcome for record in done.result.attempts if record.step.startswith("move")] == [
        "succeeded",
        "protective_stop",
        "protective_stop",
        "protective_stop",
    ]


def test_payload_is_noticed_by_moving_and_not_before(run: Rehearse) -> None:
    # Home is where the arm stands already: the first step that moves it is the third.
    failed = run(during(1, FaultKind.WRONG_PAYLOAD, "arm", when="started", after_s=0.0)).failed
    assert failed.step == "move pick"
    assert "DRIVEN" in {point.step.name for point in failed.trace}


def test_state_of_a_stopped_arm_stays_visible(run: Rehearse) -> None:
    steps = (HOME, DETECT, PICK, wait(2.0), ACKNOWLEDGE)
    done = run(during(3, FaultKind.EMERGENCY_STOP, "arm", lasting_s=1.0), steps=steps)
    (history,) = done.plant.control.histories.values()
    during_stop = (history.stamps > done.attempt(4).started_ns) & (history.stamps < done.attempt(4).ended_ns)
    assert during_stop.sum() == 999  # 500 Hz over 2 s, both ends left out


def test_acknowledgment_without_a_stop_does_nothing(run: Rehearse) -> None:
    done = run(steps=(HOME, ACKNOWLEDGE))
    assert done.attempt(2).operator_intervention == "none"
    assert done.attempt(2).started_ns == done.attempt(2).ended_ns


def test_other_role_than_the_declared_one_cannot_acknowledge(run: Rehearse) -> None:
    stranger = ACKNOWLEDGE.model_copy(update={"target": "task"})
    done = run(
        during(3, FaultKind.PROTECTIVE_STOP, "arm", lasting_s=0.1),
        steps=(HOME, DETECT, PICK, wait(1.0), stranger, HOME),
    )
    assert done.result.outcome == "protective_stop"
    assert done.attempt(5).fault_code == "task must not acknowledge, only operator may"
    assert len(done.result.attempts) == 6  # the last sums up


@pytest.mark.parametrize("second", ["protective_stop", "cut_network"])
def test_emergency_stop_outranks_every_other(run: Rehearse, second: FaultKind) -> None:
    failed = run(during(3, second, "gripper"), during(3, FaultKind.EMERGENCY_STOP, "arm")).failed
    assert (failed.outcome, failed.safety_state) == ("emergency_stop", "emergency_stop")


def test_recovered_cell_finishes_what_is_asked_anew(run: Rehearse, cell: MockCell) -> None:
    again = (HOME, DETECT, PICK, *cell.entries[0].steps[3:])
    done = run(
        during(3, FaultKind.RESTART_DRIVER, "arm", lasting_s=1.0),
        steps=(HOME, DETECT, PICK, wait(2.0), ACKNOWLEDGE, *again),
    )
    assert done.result.outcome == "succeeded"
