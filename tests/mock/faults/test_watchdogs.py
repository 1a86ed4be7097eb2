"""Each watchdog is what ends its runs: without it they end in no outcome of theirs, or beyond their bound."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.ports import FaultPorts
from cellc.mock.faults.stops import RestartDriver
from cellc.mock.nodes.observations import ObservationInbox
from cellc.mock.stops import Stops
from cellc.mock.task import context, execute, grip, move
from cellc.mock.task.context import TaskContext
from tests.mock.faults.conftest import ACKNOWLEDGE, DETECT, HOME, PICK, Rehearse, during, wait

Remove = Callable[[pytest.MonkeyPatch], None]


def _nothing(*_: Any) -> None:
    return


def _method(name: str) -> Remove:
    return lambda patch: patch.setattr(TaskContext, name, _nothing)


def _everywhere(name: str, value: Any, *modules: Any) -> Remove:
    def remove(patch: pytest.MonkeyPatch) -> None:
        for module in modules:
            patch.setattr(module, name, value)

    return remove


def _unanswered(*_: Any) -> Any:
    return iter(())


def _look_at_nothing(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(ObservationInbox, "is_stale", lambda *_: False)
    patch.setattr(TaskContext, "_observed_until_ns", lambda context: context.deadline_ns)


WATCHDOGS: list[tuple[str, FaultEntry, str, Remove]] = [
    ("stops", during(3, FaultKind.PROTECTIVE_STOP, "arm"), "protective_stop", _method("_check_effects")),
    ("owner", during(3, FaultKind.SECOND_COMMANDER, "gripper_action"), "wrong_owner", _method("_check_owner")),
    ("cycles", during(3, FaultKind.SKIP_CYCLES, cycles=5), "missed_cycle", _method("_check_cycles")),
    (
        "joint states",
        during(3, FaultKind.FREEZE, "arm"),
        "stale_state",
        _everywhere("joint_state_age_s", lambda _: 1e9, context),
    ),
    (
        "observation",
        during(3, FaultKind.FREEZE, "camera"),
        "stale_state",
        _look_at_nothing,
    ),
    (
        "authorities",
        during(3, FaultKind.DOUBLE_FRAME, "object", when="started", after_s=0.0),
        "tf_failure",
        _method("check_authorities"),
    ),
    (
        "response",
        during(3, FaultKind.UNRESPONSIVE, "arm_trajectory", when="started", after_s=0.0),
        "timeout",
        _everywhere("await_response", _unanswered, execute, move),
    ),
    (
        "arrival of the fingers",
        during(4, FaultKind.STICK, "gripper_robotiq_85_left_knuckle_joint", when="started", after_s=0.0),
        "tolerance_violation",
        _everywhere("require_part", _nothing, grip),
    ),
    (
        "result of a controller that is gone",
        during(4, FaultKind.SWITCH, "gripper_action", after_s=0.0),
        "wrong_owner",
        _everywhere("RESULT_GRACE_NS", 10**15, execute),
    ),
]


def _holds(run: Rehearse, entry: FaultEntry, outcome: str) -> bool:
    """Tell whether a run ends in its outcome, within the bound of a watchdog: 1.5 s are enough for all of these."""
    result = run(entry, timeout_s=60.0).result
    return result.outcome == outcome and result.response_s is not None and result.response_s <= 1.5


@pytest.mark.parametrize(
    ("entry", "outcome", "remove"), [case[1:] for case in WATCHDOGS], ids=[c[0] for c in WATCHDOGS]
)
def test_run_fails_without_its_watchdog(
    run: Rehearse, monkeypatch: pytest.MonkeyPatch, entry: FaultEntry, outcome: str, remove: Remove
) -> None:
    assert _holds(run, entry, outcome)
    remove(monkeypatch)
    assert not _holds(run, entry, outcome)


def test_goal_of_a_paused_robot_is_bounded_by_the_action_alone(run: Rehearse, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(move, "goal_timeout_s", lambda *_: 1e6)
    done = run(during(3, FaultKind.SCALE_SPEED, "arm", factor=0.0), timeout_s=60.0)
    assert done.failed.fault_code == "the timeout of the rehearsal expired"


def test_stop_without_a_latch_is_over_without_an_acknowledgment(run: Rehearse, monkeypatch: pytest.MonkeyPatch) -> None:
    steps = (HOME, DETECT, PICK, wait(2.0), ACKNOWLEDGE)
    entry = during(3, FaultKind.PROTECTIVE_STOP, "arm", lasting_s=1.0)
    assert run(entry, steps=steps).attempt(4).safety_state == "protective_stop"

    end_cause = Stops.end_cause

    def release(stops: Stops, component: str) -> None:
        end_cause(stops, component)
        stops.recover(0)

    monkeypatch.setattr(Stops, "end_cause", release)
    assert run(entry, steps=steps).attempt(4).safety_state == "normal"


def test_goal_that_is_sent_again_after_the_reconnect_would_be_seen(
    run: Rehearse, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps = (HOME, DETECT, PICK, wait(2.0), ACKNOWLEDGE, wait(0.5), HOME)
    sent: list[Any] = []

    def replay(fault: RestartDriver, ports: FaultPorts) -> None:
        ports.effects.end_cause(fault.device)
        ports.effects._stops.recover(0)
        manager = ports.hardware.control.managers["control"]
        manager.spawn(["arm_trajectory"])
        assert manager.send_goal("arm_trajectory", sent[-1]).accepted

    original = execute._send

    def remember(context: TaskContext, attempt: Any, controller: str, goal: Any) -> Any:
        sent.append(goal)
        return (yield from original(context, attempt, controller, goal))

    monkeypatch.setattr(execute, "_send", remember)
    monkeypatch.setattr(RestartDriver, "end", replay)
    done = run(during(3, FaultKind.RESTART_DRIVER, "arm", lasting_s=1.0), steps=steps)
    assert done.travel(done.attempt(4).started_ns, done.attempt(4).ended_ns) > 0.01
