"""Which goals are accepted, row by row of the table of facts (sections 1 and 2)."""

from __future__ import annotations

import math

import pytest

from cellc.contract.vocabulary import Distro
from cellc.mock.control import (
    GoalStatus,
    JointFault,
    JointTolerance,
    TrajectoryEnded,
    TrajectoryFeedback,
    TrajectoryGoal,
    TrajectoryPoint,
)

from .bench import S, bench, commands, ending, only, point, positions, run, send, wait
from .fact_rows import row

_NEAR = point(0.1, 0.1)


def _refused(*points: TrajectoryPoint, joints: tuple[str, ...] = ("a", "b"), stamp_ns: int = 0) -> None:
    manager = bench(start_ns=100 * S)
    before = positions(manager)
    response = send(manager, *points, joints=joints, stamp_ns=stamp_ns)
    assert not response.accepted
    assert response.log_reason  # which in reality stands in the log alone
    assert not [event for event in wait(manager, 2.0) if isinstance(event, TrajectoryEnded)]
    assert positions(manager) == before


@row("2", 1)
def test_inactive_controller_refuses() -> None:
    manager = bench(up=("joints",))
    assert manager.spawn(["arm"], inactive=True).ok
    assert not send(manager, _NEAR).accepted


@row("2", 2)
def test_fewer_joints_than_the_controller_has_are_refused() -> None:
    _refused(point(0.1), joints=("a",))


@row("2", 3)
def test_no_joint_names_are_refused() -> None:
    _refused(_NEAR, joints=())


@row("2", 4)
def test_no_points_are_refused() -> None:
    _refused()


@row("2", 5)
def test_unknown_joint_is_refused() -> None:
    _refused(_NEAR, joints=("a", "c"))


@row("2", 6)
@pytest.mark.parametrize(("velocity", "accepted"), [(0.1, False), (2e-7, False), (1e-7, True), (-0.1, False)])
def test_velocity_at_the_end_is_refused_above_the_float_epsilon(velocity: float, accepted: bool) -> None:
    assert send(bench(), point(0.1, 0.1, v=(velocity, 0.0))).accepted is accepted


@row("2", 6)
def test_humble_allows_a_velocity_at_the_end_by_default() -> None:
    assert send(bench(distro=Distro.HUMBLE, up=("joints", "arm")), point(0.1, 0.1, v=(0.1, 0.0))).accepted


@row("2", 7)
def test_trajectory_that_ended_before_now_is_refused() -> None:
    _refused(_NEAR, stamp_ns=99 * S)  # 99 s + 1 s < 100.5 s


@row("2", 8)
@pytest.mark.parametrize("second", [0.5, 0.2])
def test_times_that_do_not_increase_are_refused(second: float) -> None:
    _refused(point(0.05, 0.0, at=0.5), point(0.1, 0.0, at=second))


@row("2", 8)
@pytest.mark.parametrize("first", [0.0, -0.5])
def test_first_time_may_be_zero_or_negative(first: float) -> None:
    assert send(bench(start_ns=100 * S), point(0.0, 0.0, at=first), point(0.1, 0.0, at=1.0)).accepted


@row("2", 9)
@pytest.mark.parametrize("wrong", [(), (0.1,), (0.1, 0.1, 0.1)])
def test_number_of_positions_must_be_that_of_joints(wrong: tuple[float, ...]) -> None:
    _refused(point(*wrong))


@row("2", 9)
def test_positions_may_be_empty_where_velocities_are_integrated() -> None:
    manager = bench({"allow_integration_in_goal_trajectories": True})
    still = TrajectoryPoint((), (0.0, 0.0), (), time_from_start_ns=S)
    assert send(manager, still).accepted


@row("2", 10)
def test_number_of_velocities_must_be_that_of_joints() -> None:
    _refused(point(0.1, 0.1, v=(0.0,)))


@row("2", 10)
def test_number_of_accelerations_must_be_that_of_joints() -> None:
    _refused(point(0.1, 0.1, v=(0.0, 0.0), a=(0.0, 0.0, 0.0)))


@row("2", 11)
def test_effort_without_an_effort_interface_is_refused() -> None:
    _refused(TrajectoryPoint((0.1, 0.1), effort=(1.0, 1.0), time_from_start_ns=S))


def test_what_is_not_checked_is_accepted() -> None:
    for loose in (
        point(0.1, 0.2),
        point(math.nan, 0.0),
        point(math.inf, 0.0),
        point(99.0, 0.0),
        point(3.0, 3.0, at=0.01),
    ):
        assert send(bench(), loose).accepted
    assert send(bench(), point(0.1, 0.2), joints=("a", "a")).accepted
    assert send(bench(), _NEAR, path=(JointTolerance("nobody", 1.0),)).accepted


@row("2", 12)
def test_other_order_of_joints_is_sorted() -> None:
    manager = bench()
    send(manager, point(0.3, 0.1), joints=("b", "a"))
    assert ending(manager)[0] is GoalStatus.SUCCEEDED
    assert positions(manager) == pytest.approx((0.1, 0.3))


@row("2", 13)
def test_joint_that_a_partial_goal_leaves_out_stays() -> None:
    manager = bench({"allow_partial_joints_goal": True})
    send(manager, point(0.2, 0.3))
    assert ending(manager)[0] is GoalStatus.SUCCEEDED
    send(manager, point(0.4), joints=("b",))
    assert ending(manager)[0] is GoalStatus.SUCCEEDED
    assert positions(manager) == pytest.approx((0.2, 0.4))


@row("2", 14)
def test_goal_without_stamp_starts_with_the_next_update() -> None:
    manager = bench()
    manager.record("arm", 500.0)
    sent_ns = manager.now_ns
    send(manager, point(1.0, 0.0))
    wait(manager, 0.5)
    recording = manager.recording("arm")
    moved_ns = int(recording.stamps_ns[(recording.desired[:, 0] > 1e-9).argmax()])
    assert 0 < moved_ns - sent_ns <= 2 * manager.period_ns


@row("2", 15)
def test_future_stamp_stretches_the_first_segment() -> None:
    manager = bench(start_ns=100 * S)
    send(manager, point(0.6, 0.0, at=1.0), stamp_ns=manager.now_ns + 2 * S)
    wait(manager, 1.5)  # half of the 3 s from acceptance to the first point
    assert positions(manager)[0] == pytest.approx(0.3, abs=0.002)


@row("2", 16)
def test_past_stamp_starts_in_the_middle() -> None:
    manager = bench({"constraints.a.trajectory": 0.0}, start_ns=100 * S)
    send(manager, point(0.0, 0.0, at=0.5), point(0.4, 0.0, at=1.5), stamp_ns=manager.now_ns - S)
    wait(manager, 0.49)
    assert positions(manager)[0] == pytest.approx(0.4, abs=0.005)
    assert ending(manager)[0] is GoalStatus.SUCCEEDED


@row("2", 17)
def test_point_at_time_zero_is_commanded_at_once() -> None:
    manager = bench()
    manager.record("arm", 500.0)
    send(manager, point(0.15, 0.0, at=0.0))
    wait(manager, 0.02)
    assert 0.15 in manager.recording("arm").desired[:, 0].round(9)


@row("2", 18)
def test_result_and_feedback_come_on_ticks_of_the_monitor() -> None:
    manager = bench()
    accepted_ns = manager.now_ns
    manager.send_goal("arm", TrajectoryGoal(("a", "b"), (point(0.1, 0.1, at=0.512),)), feedback=True)
    events = run(manager, S)
    stamps = [event.stamp_ns for event in events if isinstance(event, (TrajectoryFeedback, TrajectoryEnded))]
    assert {(stamp - accepted_ns) % (S // 20) for stamp in stamps} == {0}  # 20 Hz from acceptance
    assert only(events, TrajectoryEnded).stamp_ns - accepted_ns == 550_000_000


@row("1", 7)
def test_tolerance_that_is_absent_keeps_that_of_the_controller() -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(stuck=True))
    send(manager, point(0.5, 0.0), path=(JointTolerance("a", 0.0),))
    assert ending(manager)[:2] == (GoalStatus.ABORTED, -4)


@row("1", 8)
def test_positive_tolerance_replaces() -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(stuck=True))
    send(manager, point(0.5, 0.0), path=(JointTolerance("a", 0.9),), goal=(JointTolerance("a", 0.9),))
    assert ending(manager)[:2] == (GoalStatus.SUCCEEDED, 0)


@row("1", 9)
def test_tolerance_of_minus_one_switches_the_check_off() -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(stuck=True))
    send(manager, point(0.5, 0.0), path=(JointTolerance("a", -1.0),), goal=(JointTolerance("a", -1.0),))
    assert ending(manager)[:2] == (GoalStatus.SUCCEEDED, 0)


@row("1", 10)
@pytest.mark.parametrize("bad", [JointTolerance("b", -2.0), JointTolerance("nobody", 1.0)])
def test_one_bad_tolerance_puts_the_whole_goal_on_defaults(bad: JointTolerance) -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(stuck=True))
    send(manager, point(0.5, 0.0), path=(JointTolerance("a", -1.0), bad))
    assert ending(manager)[:2] == (GoalStatus.ABORTED, -4)
    assert any(line.level == "ERROR" for line in manager.log.lines())


@row("1", 11)
@pytest.mark.parametrize(("goal_time", "waited"), [(0.0, 0.5), (-2.0, 0.5), (1.5, 1.5)])
def test_goal_time_of_the_goal_replaces_that_of_the_controller(goal_time: float, waited: float) -> None:
    manager = bench()
    manager.disturbances.disturb("a", JointFault(stuck=True))
    send(manager, point(0.1, 0.0), goal_time=goal_time)
    ended = only(wait(manager, 4.0), TrajectoryEnded)
    assert ended.error_code == -5
    assert f"exceeding by {waited:.1f}" in ended.error_string
    assert commands(manager)[0] == pytest.approx(positions(manager)[0])
