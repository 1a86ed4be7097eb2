"""How goals of a trajectory end, row by row of the table of facts (sections 1 and 4)."""

from __future__ import annotations

import pytest

from cellc.contract.vocabulary import Distro
from cellc.mock.control import ControllerManager, GoalStatus, JointFault, Trajectory, TrajectoryEnded, TrajectoryPoint

from .bench import S, Value, bench, commands, ending, only, point, positions, send, wait
from .fact_rows import row

_FREE: dict[str, Value] = {"constraints.a.trajectory": 0.0, "constraints.b.trajectory": 0.0}
_LOOSE: dict[str, Value] = _FREE | {"constraints.a.goal": 0.0, "constraints.b.goal": 0.0}


def _moving(arm: dict[str, Value] | None = None, distro: Distro = Distro.KILTED) -> tuple[ControllerManager, int]:
    """A cell in the middle of a goal, and the number of the goal."""
    manager = bench(arm, distro=distro, up=("joints", "arm"))
    goal = send(manager, point(0.8, 0.0, at=2.0))
    wait(manager, 1.0)
    return manager, goal.goal_id


def _no_end(manager: ControllerManager, seconds: float) -> bool:
    return not [event for event in wait(manager, seconds) if isinstance(event, TrajectoryEnded)]


@row("4", 1)
@row("1", 1)
def test_goal_inside_its_tolerance_succeeds() -> None:
    manager = bench()
    send(manager, point(0.4, 0.2))
    assert ending(manager) == (GoalStatus.SUCCEEDED, 0, "Goal successfully reached!")
    assert commands(manager) == (0.4, 0.2)


@row("4", 2)
def test_without_goal_tolerances_the_last_time_is_success() -> None:
    manager = bench(_LOOSE)
    manager.disturbances.disturb("a", JointFault(stuck=True))
    sent_ns = manager.now_ns
    send(manager, point(0.4, 0.0))
    ended = only(wait(manager, 3.0), TrajectoryEnded)
    assert ended.status is GoalStatus.SUCCEEDED
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(1.0, abs=0.006)
    assert positions(manager)[0] == 0.0


@row("4", 3)
@row("1", 5)
def test_path_tolerance_exceeded_aborts_and_holds() -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(lower=-0.1, upper=0.1))
    send(manager, point(0.8, 0.4))
    assert ending(manager) == (GoalStatus.ABORTED, -4, "Aborted due to path tolerance violation")
    assert commands(manager)[0] == pytest.approx(0.1, abs=1e-6)
    held = positions(manager)[1]
    wait(manager, 1.0)
    assert positions(manager)[1] == held


@row("4", 3)
def test_path_tolerance_exceeded_decelerates_where_it_is_configured() -> None:
    stop: dict[str, Value] = {"constraints.decelerate_on_cancel": True}
    stop |= {f"constraints.{joint}.max_deceleration_on_cancel": 0.5 for joint in ("a", "b")}
    manager = bench(stop)
    manager.disturbances.disturb("a", JointFault(lower=-0.1, upper=0.1))
    send(manager, point(0.8, 0.4))
    assert ending(manager)[1] == -4
    wait(manager, 2.0)
    # The error of the first joint is 0.2 at 0.375 s; the second is at 0.15 rad then, and stops from 0.4 rad/s with
    # 0.5 rad/s² over 0.16 rad.
    assert positions(manager)[1] == pytest.approx(0.31, abs=0.003)


@row("4", 4)
@row("1", 6)
def test_goal_time_exceeded_aborts() -> None:
    manager = bench(_FREE)
    manager.disturbances.disturb("a", JointFault(lower=-0.1, upper=0.1))
    send(manager, point(0.3, 0.0))
    status, code, text = ending(manager)
    assert (status, code) == (GoalStatus.ABORTED, -5)
    prefix, _, rest = text.partition("exceeding by ")
    assert prefix == "Aborted due to goal_time_tolerance "
    assert rest.endswith(" seconds")
    assert float(rest.removesuffix(" seconds")) == pytest.approx(0.5, abs=0.003)
    assert len(rest.removesuffix(" seconds").partition(".")[2]) == 6


@row("4", 5)
def test_without_goal_time_a_goal_may_never_end() -> None:
    manager = bench(_FREE | {"constraints.goal_time": 0.0})
    manager.disturbances.disturb("a", JointFault(lower=-0.1, upper=0.1))
    send(manager, point(0.3, 0.0))
    assert _no_end(manager, 300.0)
    assert commands(manager)[0] == 0.3


@row("4", 6)
@row("1", 2)
@pytest.mark.parametrize(
    ("distro", "text"),
    [
        (Distro.HUMBLE, "Current goal cancelled due to new incoming action."),
        (Distro.JAZZY, "Current goal preempted by new incoming action."),
        (Distro.KILTED, "Current goal preempted by new incoming action."),
        (Distro.LYRICAL, "Current goal preempted by new incoming action."),
    ],
)
def test_new_goal_aborts_the_running_one(distro: Distro, text: str) -> None:
    manager, first = _moving(distro=distro)
    assert send(manager, point(0.0, 0.0, at=1.0)).accepted
    ended = [event for event in wait(manager, 3.0) if isinstance(event, TrajectoryEnded)]
    assert (ended[0].goal_id, ended[0].status, ended[0].error_code) == (first, GoalStatus.ABORTED, -1)
    assert ended[0].error_string == text
    assert ended[1].status is GoalStatus.SUCCEEDED
    assert positions(manager)[0] == pytest.approx(0.0, abs=1e-9)


@row("4", 7)
def test_refused_goal_leaves_the_running_one_alone() -> None:
    manager, first = _moving()
    assert not send(manager).accepted
    ended = only(wait(manager, 3.0), TrajectoryEnded)
    assert (ended.goal_id, ended.status) == (first, GoalStatus.SUCCEEDED)
    assert positions(manager)[0] == pytest.approx(0.8)


@row("4", 8)
@row("1", 1)
def test_cancel_holds_and_carries_no_text() -> None:
    manager, goal = _moving()
    answer = manager.cancel_goal(goal)
    assert (answer.return_code, answer.goals_canceling) == (0, (goal,))
    at = positions(manager)[0]
    assert ending(manager) == (GoalStatus.CANCELED, 0, "")
    assert positions(manager)[0] == pytest.approx(at, abs=0.002)  # 0.4 rad/s for two cycles of 2 ms


@row("4", 8)
def test_cancel_decelerates_where_it_is_configured() -> None:
    stop: dict[str, Value] = {"constraints.decelerate_on_cancel": True}
    stop |= {f"constraints.{joint}.max_deceleration_on_cancel": 0.5 for joint in ("a", "b")}
    manager, goal = _moving(stop)
    at = positions(manager)[0]
    manager.cancel_goal(goal)
    assert ending(manager)[0] is GoalStatus.CANCELED
    wait(manager, 2.0)
    assert positions(manager)[0] == pytest.approx(at + 0.16, abs=0.002)  # 0.4² / (2 · 0.5)


@row("4", 9)
def test_cancel_of_another_goal_changes_nothing() -> None:
    manager, goal = _moving()
    send(manager, point(0.0, 0.0, at=1.0))
    wait(manager, 0.2)
    assert manager.cancel_goal(goal).return_code == 3  # it has ended
    assert ending(manager)[0] is GoalStatus.SUCCEEDED


@row("4", 10)
def test_deactivation_aborts_and_leaves_the_last_command() -> None:
    manager, _ = _moving()
    manager.switch_controllers([], ["arm"])
    assert ending(manager) == (GoalStatus.ABORTED, -1, "Current goal cancelled during deactivate transition.")
    left = commands(manager)[0]
    assert left == pytest.approx(positions(manager)[0], abs=0.002)
    wait(manager, 1.0)
    assert commands(manager)[0] == left


def _publish(manager: ControllerManager, *points: TrajectoryPoint, joints: tuple[str, ...] = ("a", "b")) -> None:
    manager.publish_trajectory("arm", Trajectory(joints, points))


@row("4", 11)
def test_message_on_the_topic_replaces_the_motion_of_the_goal() -> None:
    manager, goal = _moving()
    _publish(manager, point(-0.2, 0.1, at=2.0))
    ended = only(wait(manager, 5.0), TrajectoryEnded)
    assert (ended.goal_id, ended.status) == (goal, GoalStatus.SUCCEEDED)
    assert positions(manager) == pytest.approx((-0.2, 0.1))


@row("4", 12)
def test_invalid_message_on_the_topic_is_ignored() -> None:
    manager, _ = _moving()
    _publish(manager, point(0.0, at=1.0), joints=("c",))
    assert ending(manager)[0] is GoalStatus.SUCCEEDED
    assert positions(manager)[0] == pytest.approx(0.8)


@row("4", 13)
@pytest.mark.parametrize("target", [0.8, 0.25])
def test_topic_trajectory_that_fails_has_no_result_and_holds(target: float) -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(lower=-0.1, upper=0.1))
    _publish(manager, point(target, 0.0))  # the path tolerance, and the goal time
    assert _no_end(manager, 5.0)
    assert commands(manager)[0] == pytest.approx(0.1, abs=1e-6)


@row("4", 14)
def test_command_timeout_holds_without_a_result_of_its_own() -> None:
    manager = bench(_FREE | {"cmd_timeout": 0.6})
    _publish(manager, point(0.2, 0.0))
    wait(manager, 3.0)
    assert any("Aborted due to command timeout" in line.text for line in manager.log.lines())
    assert positions(manager)[0] == pytest.approx(0.2)


@row("4", 15)
def test_activation_holds_the_position_it_finds() -> None:
    manager, _ = _moving()
    manager.switch_controllers([], ["arm"])
    wait(manager, 0.1)
    at = positions(manager)
    manager.switch_controllers(["arm"], [])
    wait(manager, 1.0)
    assert positions(manager) == pytest.approx(at, abs=1e-6)


@row("4", 16)
def test_state_is_answered_only_while_a_trajectory_runs() -> None:
    manager = bench()
    assert not manager.query_state("arm", manager.now_ns).success
    begin_ns = manager.now_ns + manager.period_ns
    send(manager, point(0.4, 0.0, at=2.0))
    wait(manager, 1.0)
    answer = manager.query_state("arm", begin_ns + S)
    assert answer.success
    assert answer.positions == pytest.approx((0.2, 0.0), abs=1e-6)
    assert not manager.query_state("arm", begin_ns - S).success
    assert not manager.query_state("arm", begin_ns + 5 * S).success
    manager.switch_controllers([], ["arm"])
    wait(manager, 0.1)
    assert not manager.query_state("arm", begin_ns + S).success


@row("1", 3)
@row("1", 4)
@pytest.mark.parametrize("joints", [("a", "c"), ("c", "d")])
def test_codes_of_joints_and_old_stamps_are_never_sent(joints: tuple[str, ...]) -> None:
    manager = bench(start_ns=100 * S)
    assert send(manager, point(0.1, 0.1), joints=joints).goal_id == 0
    assert send(manager, point(0.1, 0.1), stamp_ns=S).goal_id == 0
    assert _no_end(manager, 2.0)  # a refused goal has no result, and so no code
