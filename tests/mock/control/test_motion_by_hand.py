"""Stops, limits and faults of joints, worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.mock.control import JointFault
from cellc.mock.control.controllers.joint_trajectory.motion import stop_points
from cellc.mock.control.hardware.joint_motion import differences, integral
from cellc.mock.control.hardware.limiter import CommandLimiter
from cellc.mock.control.interfaces import InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.robot_description import JointLimits

LIMITS = JointLimits(-1.0, 1.0, velocity=1.0, effort=5.0, acceleration=2.0)


def test_stop_takes_speed_over_deceleration_and_half_of_that_as_way() -> None:
    points = stop_points(np.array([0.0, 1.0]), np.array([1.0, -0.5]), np.array([2.0, 2.0]), 100_000_000)
    # Joint 1 stops after 1/2 s at 1^2/(2*2) = 0.25, joint 2 after 0.25 s at 1 - 0.5^2/(2*2) = 0.9375.
    assert [point.time_from_start_ns for point in points] == [n * 100_000_000 for n in range(7)]
    # After 0.2 s: 0.2 - 0.5*2*0.04 and 1 - 0.1 + 0.5*2*0.04; speeds 1 - 0.4 and -0.5 + 0.4.
    assert points[2].positions == pytest.approx((0.16, 0.94))
    assert points[2].velocities == pytest.approx((0.6, -0.1))
    assert points[2].accelerations == (-2.0, 2.0)
    # After 0.3 s: 0.3 - 0.5*2*0.09; the other stands.
    assert points[3].positions == pytest.approx((0.21, 0.9375))
    assert points[3].velocities == pytest.approx((0.4, 0.0))
    assert points[-1].positions == pytest.approx((0.25, 0.9375))
    assert points[-1].velocities == (0.0, 0.0)


@pytest.mark.parametrize(
    ("fault", "expected"),
    [
        (JointFault(time_constant_s=0.03), (0.25, 0.4375)),  # 0.01/(0.03 + 0.01) of what is left: 1/4, then of 3/4
        (JointFault(max_velocity=5.0), (0.05, 0.1)),  # 5 * 0.01 a cycle
        (JointFault(offset=0.2), (1.2, 1.2)),
        (JointFault(upper=0.4), (0.4, 0.4)),
        (JointFault(time_constant_s=0.03, upper=0.2), (0.2, 0.2)),  # 0.25 is cut; then 0.2 + 0.8/4 is cut
        (JointFault(stuck=True), (0.0, 0.0)),
    ],
)
def test_faulty_joint_follows_a_step_of_one(fault: JointFault, expected: tuple[float, ...]) -> None:
    assert fault.follow(np.ones(2), 0.0, 0.01).tolist() == pytest.approx(expected)


def test_rates_and_ways_of_cycles() -> None:
    # (0.3 - 0.1)/0.1 and (0.2 - 0.3)/0.1; back: 0.1 + 2*0.1, then - 1*0.1.
    rates = differences(np.array([[0.3], [0.2]]), np.array([0.1]), 0.1)
    assert rates[:, 0].tolist() == pytest.approx([2.0, -1.0])
    assert integral(rates, np.array([0.1]), 0.1)[:, 0].tolist() == pytest.approx([0.3, 0.2])


def limiter(kind: str, position: float, velocity: float) -> tuple[CommandLimiter, int]:
    table = InterfaceTable()
    column = table.add_command(f"a/{kind}", 0.0)
    table.add_state("a/position", position)
    table.add_state("a/velocity", velocity)
    return CommandLimiter({"a": LIMITS}, table, 10_000_000, Log()), column


def test_position_goes_as_far_as_speed_and_acceleration_allow_in_a_cycle() -> None:
    limits, column = limiter("position", 0.0, -0.1)
    # |-0.1| + 2*0.01 = 0.12 of 1 rad/s, and 0.12*0.01 a cycle, from the command before.
    assert [limits.limit(column, 1.0) for _ in range(2)] == pytest.approx([0.0012, 0.0024])
    fast, column = limiter("position", 0.995, 3.0)
    assert fast.limit(column, 2.0) == 1.0  # 0.995 + min(1, 3.02)*0.01 is beyond the end
    fast, column = limiter("position", 0.5, 3.0)
    assert fast.limit(column, -2.0) == pytest.approx(0.49)  # 0.5 - 1*0.01


def test_velocity_ends_at_the_end_of_the_way_and_changes_by_the_acceleration() -> None:
    limits, column = limiter("velocity", 0.995, 0.0)
    assert limits.limit(column, 3.0) == pytest.approx(0.5)  # (1 - 0.995)/0.01
    assert limits.limit(column, 0.0) == pytest.approx(0.48)  # 0.5 - 2*0.01
    low, column = limiter("velocity", -0.997, 0.0)
    assert low.limit(column, -3.0) == pytest.approx(-0.3)  # (-1 + 0.997)/0.01


@pytest.mark.parametrize(
    ("position", "velocity", "wanted", "limited"),
    [
        (0.0, 0.0, 9.0, 5.0),
        (0.0, 0.0, -9.0, -5.0),
        (1.0, 0.0, 9.0, 0.0),  # at its upper end, not on its way back
        (1.0, -0.1, 9.0, 5.0),
        (-1.0, 0.0, -9.0, 0.0),
        (-1.0, 0.1, -9.0, -5.0),
        (0.0, 1.1, 9.0, 0.0),  # faster than allowed: only against the motion
        (0.0, -1.1, -9.0, 0.0),
    ],
)
def test_effort_drives_nothing_on_beyond_its_limits(
    position: float, velocity: float, wanted: float, limited: float
) -> None:
    limits, column = limiter("effort", position, velocity)
    assert limits.limit(column, wanted) == limited


def test_acceleration_is_bounded_both_ways() -> None:
    limits, column = limiter("acceleration", 0.0, 0.0)
    assert [limits.limit(column, value) for value in (3.0, -3.0, 1.5)] == [2.0, -2.0, 1.5]


def test_column_of_an_interface_that_is_there_keeps_its_value() -> None:
    table = InterfaceTable()
    assert [table.add_command(name, value) for name, value in (("a/x", 1.0), ("b/x", 2.0), ("a/x", 3.0))] == [0, 1, 0]
    assert [table.add_state(name, value) for name, value in (("a/x", 1.0), ("b/x", 2.0), ("a/x", 3.0))] == [0, 1, 0]
    assert (table.command.tolist(), table.state.tolist()) == ([1.0, 2.0], [1.0, 2.0])
    assert table.journal.interface_names == ["a/x", "b/x"]
