"""A trajectory on an adapter: where it ends, and how it is given up. Expected values by hand."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.contract.adapter import (
    AdapterModel,
    FollowerResult,
    FollowerStatus,
    JointCommand,
    JointModel,
    Trajectory,
    TrajectoryFollower,
    Unit,
    Waypoint,
)
from cellc.mock.adapter.simulated import SimulatedAdapter
from cellc.mock.control import JointFault

PERIOD_S = 0.002


class Arm:
    """One joint that may go at 1 rad/s, from 0 to 1 rad, with a follower on it."""

    def __init__(self, trajectory: Trajectory, velocity: float = 1.0) -> None:
        self.now_ns = 0
        joint = JointModel("joint", Unit.RADIAN, -0.1, 1.05, velocity)
        model = AdapterModel("arm", (joint,), "arm", PERIOD_S, command_timeout_s=0.02, stop_time_s=0.1)
        self.adapter = SimulatedAdapter(model, (0.0,), lambda: self.now_ns)
        self.adapter.connect()
        self.adapter.activate()
        self.follower = TrajectoryFollower(self.adapter, trajectory, path_tolerance=0.01, goal_time_s=0.5)

    def run(self, seconds: float) -> FollowerResult | None:
        """Step for a time, or to the end."""
        for _ in range(round(seconds / PERIOD_S)):
            if self.follower.step() is not None:
                break
            self.now_ns += round(PERIOD_S * 1e9)
        return self.follower.result


def rest_to_rest(distance: float, duration_s: float) -> Trajectory:
    """Return a trajectory from rest at 0 to rest; its greatest speed is 15/8 of the mean one."""
    return Trajectory(
        (Waypoint(0.0, (0.0,), (0.0,), (0.0,)), Waypoint(duration_s, (distance,), (0.0,), (0.0,))),
    )


def test_trajectory_is_followed_to_its_end() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0))
    result = arm.run(5.0)
    assert result == FollowerResult(FollowerStatus.SUCCEEDED)
    assert arm.adapter.read().positions == pytest.approx((1.0,), abs=1e-9)
    assert arm.now_ns / 1e9 == pytest.approx(2.0, abs=0.01)


def test_segment_meets_position_velocity_and_acceleration_at_both_ends() -> None:
    trajectory = Trajectory(
        (Waypoint(0.0, (0.1,), (0.2,), (-0.3,)), Waypoint(0.8, (0.5,), (-0.1,), (0.4,))),
    )
    # An independent fit: the one polynomial of fifth degree with these six values.
    t = 0.8
    rows: list[list[float]] = [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 2, 0, 0, 0]]
    rows += [[t**k for k in range(6)], [k * t ** max(0, k - 1) for k in range(6)]]
    rows += [[k * (k - 1) * t ** max(0, k - 2) for k in range(6)]]
    coefficients = np.linalg.solve(np.array(rows, dtype=float), np.array([0.1, 0.2, -0.3, 0.5, -0.1, 0.4]))
    for time_s in np.linspace(0.0, 0.8, 33):
        expected = sum(c * time_s**k for k, c in enumerate(coefficients))
        assert trajectory.positions(float(time_s))[0] == pytest.approx(expected, abs=1e-12)


def test_cancel_ends_at_standstill_before_the_stop_time_is_over() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0))
    arm.run(1.0)
    canceled_ns = arm.now_ns
    arm.follower.cancel()
    result = arm.run(1.0)
    assert result == FollowerResult(FollowerStatus.CANCELED)
    assert (arm.now_ns - canceled_ns) / 1e9 <= 0.1 + PERIOD_S
    # Half way at 15/16 rad/s, then slowed down evenly for 0.1 s: half of what that speed would have covered.
    assert arm.adapter.read().positions[0] == pytest.approx(0.5 + 0.9375 * 0.05, abs=0.003)


def test_joint_that_sticks_ends_in_a_violated_path_tolerance() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0))
    arm.run(0.5)
    arm.adapter.disturb("joint", JointFault(stuck=True))
    result = arm.run(1.0)
    assert result is not None
    assert result.status is FollowerStatus.PATH_TOLERANCE_VIOLATED
    assert result.text.startswith("`joint` is 0.0")


def test_joint_that_lags_is_behind_by_its_velocity_times_its_time_constant() -> None:
    arm = Arm(Trajectory((Waypoint(0.0, (0.0,), (0.4,), (0.0,)), Waypoint(2.0, (0.8,), (0.4,), (0.0,)))))
    arm.adapter.disturb("joint", JointFault(time_constant_s=0.02))
    arm.run(1.0)
    assert 0.4 - arm.adapter.read().positions[0] == pytest.approx(0.4 * 0.02, abs=0.4 * PERIOD_S)


def test_trajectory_that_is_too_fast_is_refused_and_held() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0), velocity=0.5)  # it would reach 0.94 rad/s
    result = arm.run(3.0)
    assert result is not None
    assert result.status is FollowerStatus.STOPPED
    assert "`joint` is sent off at 0.50" in result.text
    assert arm.adapter.read().velocities == pytest.approx((0.0,), abs=1e-3)


def test_vendor_stop_ends_the_trajectory_with_the_reason_of_the_device() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0))
    arm.run(0.5)
    arm.adapter.trip("protective stop")
    assert arm.run(1.0) == FollowerResult(FollowerStatus.STOPPED, "protective stop")
    with pytest.raises(RuntimeError, match="still has reason to stop: protective stop"):
        arm.adapter.acknowledge()
    arm.adapter.release()
    arm.adapter.acknowledge()


def test_follower_that_is_no_longer_called_is_stopped_by_the_watchdog() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0))
    arm.run(1.0)
    arm.now_ns += 200_000_000
    state = arm.adapter.read()
    assert state.fault == "no command within the watchdog's time"
    assert state.velocities == (0.0,)
    assert arm.run(1.0) == FollowerResult(FollowerStatus.STOPPED, state.fault)


@pytest.mark.parametrize("times", [(0.0,), (0.0, 0.0), (1.0, 0.5)])
def test_trajectory_without_rising_times_is_none(times: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"trajectory"):
        Trajectory(tuple(Waypoint(time_s, (0.0,), (0.0,), (0.0,)) for time_s in times))


def test_hold_slows_down_evenly_in_the_stop_time() -> None:
    arm = Arm(rest_to_rest(1.0, 2.0))
    assert arm.adapter.command(JointCommand(0, (0.002,))) is None
    arm.now_ns = 1_000_000
    state = arm.adapter.read()
    assert (*state.positions, *state.velocities) == pytest.approx((0.001, 1.0))  # half of 2 ms
    arm.now_ns = 2_000_000
    arm.adapter.hold()
    moved = []
    for after_ms in (50, 100, 200):
        arm.now_ns = (2 + after_ms) * 1_000_000
        state = arm.adapter.read()
        moved.append((*state.positions, *state.velocities))
    # 1 rad/s falls to 0 in 0.1 s: after 0.05 s 0.002 + 0.05 - 0.05^2/0.2 at half the speed, then 0.002 + 0.1/2.
    assert moved == [pytest.approx((0.0395, 0.5)), pytest.approx((0.052, 0.0)), pytest.approx((0.052, 0.0))]
