"""How a trajectory is executed, row by row of the table of facts (sections 3 and 5)."""

from __future__ import annotations

import math

import pytest

from cellc.contract.vocabulary import Behavior
from cellc.mock.control import ControllerManager, GoalStatus, JointFault, TrajectoryEnded

from .bench import S, Value, bench, commands, ending, only, point, positions, send, urdf, wait
from .fact_rows import row

_FREE: dict[str, Value] = {"constraints.a.trajectory": 0.0, "constraints.b.trajectory": 0.0}


def _halfway(manager: ControllerManager) -> float:
    """Return the desired position of the first joint half a second into a goal that starts with the next cycle."""
    begin_ns = manager.now_ns + manager.period_ns
    wait(manager, 0.6)
    recording = manager.recording("arm")
    return float(recording.desired[abs(recording.stamps_ns - (begin_ns + S // 2)).argmin(), 0])


@row("3", 1)
@pytest.mark.parametrize(
    ("velocities", "accelerations", "halfway"),
    [
        ((), (), 0.2),  # 0.4 · t at 0.5 s
        ((0.0, 0.0), (), 0.4 * (3 * 0.25 - 2 * 0.125)),  # 3t² − 2t³
        ((0.0, 0.0), (0.0, 0.0), 0.4 * (10 * 0.125 - 15 * 0.0625 + 6 * 0.03125)),  # 10t³ − 15t⁴ + 6t⁵
    ],
)
def test_spline_follows_from_what_the_points_give(
    velocities: tuple[float, ...], accelerations: tuple[float, ...], halfway: float
) -> None:
    manager = bench()
    manager.record("arm", 500.0)
    send(manager, point(0.4, 0.0, v=velocities, a=accelerations))
    assert _halfway(manager) == pytest.approx(halfway, abs=1e-9)


@row("3", 1)
def test_without_interpolation_the_point_is_a_step() -> None:
    manager = bench({"interpolation_method": "none"} | _FREE)
    manager.record("arm", 500.0)
    send(manager, point(0.1, 0.0, at=0.4), point(0.3, 0.0, at=1.0))
    assert _halfway(manager) in (0.1, 0.3)


@row("3", 2)
def test_first_segment_begins_at_the_measured_state() -> None:
    manager = bench(_FREE)
    manager.disturbances.disturb("a", JointFault(offset=0.05))
    wait(manager, 0.1)
    measured = positions(manager)[0]
    manager.record("arm", 500.0)
    begin_ns = manager.now_ns
    send(manager, point(0.4, 0.0))
    wait(manager, 0.1)
    recording = manager.recording("arm")
    first = recording.desired[recording.stamps_ns > begin_ns][1, 0]
    assert measured == pytest.approx(0.05)
    assert first == pytest.approx(measured, abs=0.002)


@row("3", 3)
@pytest.mark.parametrize(("factor", "seconds"), [(1.0, 1.0), (0.5, 2.0), (0.25, 4.0)])
def test_speed_scaling_stretches_the_time_of_the_trajectory(factor: float, seconds: float) -> None:
    manager = bench()
    manager.publish_speed_scaling("arm", factor)
    wait(manager, 0.01)
    sent_ns = manager.now_ns
    send(manager, point(0.4, 0.0))
    ended = only(wait(manager, 5.0), TrajectoryEnded)
    assert ended.status is GoalStatus.SUCCEEDED
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(seconds, abs=0.02)


@row("5", 3)
def test_factor_of_zero_neither_progresses_nor_aborts() -> None:
    manager = bench()
    send(manager, point(0.4, 0.0))
    wait(manager, 0.5)
    manager.publish_speed_scaling("arm", 0.0)
    wait(manager, 0.1)
    paused = positions(manager)
    assert not [event for event in wait(manager, 60.0) if isinstance(event, TrajectoryEnded)]
    assert positions(manager) == pytest.approx(paused, abs=1e-9)
    manager.publish_speed_scaling("arm", 1.0)
    assert ending(manager)[0] is GoalStatus.SUCCEEDED


@row("3", 4)
def test_command_is_sampled_one_period_ahead() -> None:
    manager = bench()
    manager.record("arm", 500.0)
    send(manager, point(0.5, 0.0))
    wait(manager, 0.5)
    recording = manager.recording("arm")
    lead = recording.command[-5:, 0] - recording.desired[-5:, 0]
    assert lead == pytest.approx([0.5 * 0.002] * 5, abs=1e-9)  # 0.5 rad/s for 2 ms


@row("3", 5)
def test_continuous_joint_takes_the_short_way() -> None:
    turning = urdf().replace('name="a" type="revolute"', 'name="a" type="continuous"')
    turning = turning.replace(' lower="-3" upper="3"', "", 1)
    manager = bench({"constraints.a.goal": 0.01} | _FREE, description=turning)
    send(manager, point(2.0, 0.0, at=2.0), point(3.0, 0.0, at=3.0))
    assert ending(manager, 5.0)[0] is GoalStatus.SUCCEEDED
    manager.record("arm", 500.0)
    send(manager, point(-3.0, 0.0, at=1.0))  # 0.283 rad further, not 6 rad back
    wait(manager, 0.5)
    half = 3.0 + (2 * math.pi - 6.0) / 2
    off = math.remainder(float(manager.recording("arm").desired[-1, 0]) - half, 2 * math.pi)
    assert off == pytest.approx(0.0, abs=0.003)


@row("3", 6)
def test_path_tolerance_is_checked_in_each_cycle_before_the_last_point() -> None:
    manager = bench()
    sent_ns = manager.now_ns
    manager.disturbances.disturb("a", JointFault(stuck=True))
    send(manager, point(0.5, 0.0))
    ended = only(wait(manager, 3.0), TrajectoryEnded)
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(0.4, abs=0.006)  # 0.2 rad of error at 0.5 rad/s


@row("3", 6)
def test_first_sample_is_checked_too() -> None:
    manager = bench()
    sent_ns = manager.now_ns
    send(manager, point(0.3, 0.0, at=0.0))
    ended = only(wait(manager, 3.0), TrajectoryEnded)
    assert ended.error_code == -4
    assert ended.decided_ns - sent_ns <= 2 * manager.period_ns


@row("3", 7)
def test_goal_tolerance_is_checked_in_each_cycle_after_the_last_point() -> None:
    manager = bench()
    sent_ns = manager.now_ns
    manager.disturbances.disturb("a", JointFault(max_velocity=0.12))
    send(manager, point(0.15, 0.0))  # 0.14 rad, inside the tolerance, are reached after 1.167 s
    ended = only(wait(manager, 3.0), TrajectoryEnded)
    assert ended.status is GoalStatus.SUCCEEDED
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(0.14 / 0.12, abs=0.01)


@row("3", 8)
def test_stopped_velocity_tolerance_has_no_effect_on_a_position_command() -> None:
    manager = bench({"constraints.stopped_velocity_tolerance": 1e-6})
    manager.disturbances.disturb("a", JointFault(max_velocity=0.12))
    send(manager, point(0.15, 0.0))  # it is still moving when it comes inside the tolerance
    ended = only(wait(manager, 3.0), TrajectoryEnded)
    assert ended.status is GoalStatus.SUCCEEDED
    assert positions(manager)[0] <= 0.15


@row("3", 9)
def test_last_point_is_commanded_after_success() -> None:
    manager = bench()
    send(manager, point(0.4, -0.2))
    assert ending(manager)[0] is GoalStatus.SUCCEEDED
    wait(manager, 30.0)
    assert commands(manager) == (0.4, -0.2)


@row("5", 1)
def test_scaled_controller_reads_the_factor_of_the_hardware() -> None:
    described = urdf().replace(
        '<sensor name="wrist">',
        '<gpio name="speed_scaling"><state_interface name="speed_scaling_factor">'
        '<param name="initial_value">0.5</param></state_interface></gpio><sensor name="wrist">',
    )
    vendor = {"arm": "vendor_controllers/ScaledTrajectory"}
    behaviors = {"vendor_controllers/ScaledTrajectory": Behavior.SCALED_JOINT_TRAJECTORY}
    named: dict[str, Value] = {"speed_scaling_interface_name": "speed_scaling/speed_scaling_factor"}
    manager = bench(named, types=vendor, description=described, behaviors=behaviors)
    sent_ns = manager.now_ns
    send(manager, point(0.4, 0.0))
    ended = only(wait(manager, 5.0), TrajectoryEnded)
    assert (ended.decided_ns - sent_ns) / S == pytest.approx(2.0, abs=0.02)
