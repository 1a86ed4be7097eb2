"""Time parameterisation: limits by dense sampling of the controller's quintic, exactness against ruckig."""

from __future__ import annotations

import math

import numpy as np
import pytest
import ruckig

from cellc.contract.transforms import Pose
from cellc.robot.planning import (
    CollisionScene,
    JointLimits,
    JointPath,
    LimitsError,
    Planner,
    RobotModel,
    TimedTrajectory,
    time_parameterize,
)
from cellc.robot.planning.motion_law import rest_to_rest, rest_to_rest_durations

from .arm import ADJACENT, GROUP, HOME, JOINTS, LIMITS, arm_urdf
from .interpolation import derivatives_between

GOAL = (0.9, -1.2, 2.0, -2.3, -1.2, 0.7)


def _assert_within_limits(trajectory: TimedTrajectory, limits: JointLimits) -> None:
    _, (position, velocity, acceleration, jerk) = derivatives_between(trajectory, 200)
    assert np.all(position >= limits.lower)
    assert np.all(position <= limits.upper)
    for values, limit in ((velocity, limits.velocity), (acceleration, limits.acceleration), (jerk, limits.jerk)):
        assert np.max(np.abs(values) / np.array(limit)) <= 1.0


def _line_path() -> JointPath:
    model = RobotModel.from_urdf(arm_urdf())
    planner = Planner(model, GROUP, LIMITS, CollisionScene(model, disabled_collisions=ADJACENT))
    x, y, z = planner.tip_pose(HOME).position
    path = planner.plan_cartesian(HOME, Pose((x + 0.05, y + 0.1, z - 0.15), planner.tip_pose(HOME).quaternion))
    assert isinstance(path, JointPath)
    return path


def test_straight_edge_keeps_the_limits_between_points() -> None:
    _assert_within_limits(time_parameterize(JointPath(JOINTS, ((HOME, GOAL),)), LIMITS), LIMITS)


def test_random_edges_keep_the_limits_and_use_one_of_them_fully() -> None:
    generator = np.random.default_rng(4)
    for _ in range(25):
        ends = generator.uniform(-1.5, 1.5, size=(3, 6)) * generator.choice([1.0, 0.1, 0.001])
        first, second, third = (tuple(row) for row in ends.tolist())
        limits = JointLimits(
            JOINTS,
            LIMITS.lower,
            LIMITS.upper,
            tuple(generator.uniform(0.5, 4.0, 6).tolist()),
            tuple(generator.uniform(1.0, 20.0, 6).tolist()),
            tuple(generator.uniform(10.0, 5000.0, 6).tolist()),
        )
        trajectory = time_parameterize(JointPath(JOINTS, ((first, second), (second, third))), limits)
        _assert_within_limits(trajectory, limits)
        assert trajectory.limit_use.as_speed >= 0.999


def test_phase_too_short_for_its_own_point_does_not_break_the_limits() -> None:
    # From rest to rest without a cruise: v = a (ramp + hold), d = v (2 ramp + hold), with 50 microseconds of hold.
    acceleration, jerk = 5.0, 500.0
    ramp, hold = acceleration / jerk, 5e-5
    distance = acceleration * (ramp + hold) * (2.0 * ramp + hold)
    limits = JointLimits(JOINTS, LIMITS.lower, LIMITS.upper, (10.0,) * 6, (acceleration,) * 6, (jerk,) * 6)
    goal = (HOME[0] + distance, *HOME[1:])
    trajectory = time_parameterize(JointPath(JOINTS, ((HOME, goal),)), limits)
    _assert_within_limits(trajectory, limits)
    assert trajectory.limit_use.as_speed <= 1.0
    assert trajectory.duration_ns * 1e-9 == pytest.approx(4.0 * ramp + 2.0 * hold, rel=0.1)


def test_phase_that_comes_and_goes_with_the_scale_does_not_break_the_limits() -> None:
    # Found by random search: the held phase is 0.1 ms long to a few microseconds, the least spacing of points.
    first = (-4.096661e-07, -5.752840e-06, 3.405032e-06, -2.123902e-06, -1.064136e-05, -3.607275e-06)
    last = (4.196341e-06, -3.066313e-06, 1.720328e-06, -9.984981e-06, 5.311945e-06, -5.695985e-06)
    acceleration = (0.10716556608687267, 11.757800030165763, 25.9562783, 17.58944114, 4.81672799210509, 0.44596045)
    jerk = (71.25438988186546, 2477.947851104326, 8.587599841012974, 909.118493324291, 398.83485485462, 526.331993)
    limits = JointLimits(JOINTS, LIMITS.lower, LIMITS.upper, LIMITS.velocity, acceleration, jerk)
    _assert_within_limits(time_parameterize(JointPath(JOINTS, ((first, last),)), limits), limits)


def test_cartesian_section_keeps_the_limits_between_points() -> None:
    trajectory = time_parameterize(_line_path(), LIMITS)
    _assert_within_limits(trajectory, LIMITS)
    assert trajectory.limit_use.as_speed >= 0.999


def test_stated_use_of_limits_is_an_upper_bound_and_nearly_reached() -> None:
    for path in (JointPath(JOINTS, ((HOME, GOAL),)), _line_path()):
        trajectory = time_parameterize(path, LIMITS)
        _, (_, velocity, acceleration, jerk) = derivatives_between(trajectory, 400)
        use = trajectory.limit_use
        for values, limit, stated in (
            (velocity, LIMITS.velocity, use.velocity),
            (acceleration, LIMITS.acceleration, use.acceleration),
            (jerk, LIMITS.jerk, use.jerk),
        ):
            sampled = float(np.max(np.abs(values) / np.array(limit)))
            assert sampled <= stated + 1e-9
            assert stated <= sampled * 1.02


def test_interpolation_of_a_straight_edge_is_the_ruckig_trajectory() -> None:
    trajectory = time_parameterize(JointPath(JOINTS, ((HOME, GOAL),)), LIMITS)
    lengths = np.abs(np.subtract(GOAL, HOME))
    use = 1.0 - 1e-6
    request = ruckig.InputParameter(1)
    request.target_position = [1.0]
    request.max_velocity = [float(np.min(np.array(LIMITS.velocity) / lengths)) * use]
    request.max_acceleration = [float(np.min(np.array(LIMITS.acceleration) / lengths)) * use**2]
    request.max_jerk = [float(np.min(np.array(LIMITS.jerk) / lengths)) * use**3]
    law = ruckig.Trajectory(1)
    ruckig.Ruckig(1).calculate(request, law)
    times, (position, velocity, acceleration, _) = derivatives_between(trajectory, 100)
    motion = np.array([[value[0] for value in law.at_time(time)] for time in times])
    direction = np.subtract(GOAL, HOME)
    np.testing.assert_allclose(position, np.array(HOME) + motion[:, :1] * direction, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(velocity, motion[:, 1:2] * direction, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(acceleration, motion[:, 2:3] * direction, rtol=0.0, atol=1e-5)


def test_interpolation_of_a_moving_start_is_the_ruckig_trajectory() -> None:
    start_velocity = (0.5, -0.3, 0.0, 1.0, 0.2, -0.8)
    trajectory = time_parameterize(JointPath(JOINTS, ((HOME, GOAL),)), LIMITS, start_velocity=start_velocity)
    request = ruckig.InputParameter(6)
    request.current_position, request.current_velocity = list(HOME), list(start_velocity)
    request.target_position = list(GOAL)
    request.max_velocity, request.max_acceleration = list(LIMITS.velocity), list(LIMITS.acceleration)
    request.max_jerk = list(LIMITS.jerk)
    law = ruckig.Trajectory(6)
    ruckig.Ruckig(6).calculate(request, law)
    times, (position, velocity, _, _) = derivatives_between(trajectory, 100)
    expected = np.array([law.at_time(time) for time in times])
    np.testing.assert_allclose(position, expected[:, 0], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(velocity, expected[:, 1], rtol=0.0, atol=1e-7)
    assert len(trajectory.points) > 8  # the joints change their jerk at different instants


def test_interpolation_of_a_cartesian_section_stays_on_the_line() -> None:
    path = _line_path()
    model = RobotModel.from_urdf(arm_urdf())
    planner = Planner(model, GROUP, LIMITS)
    start = np.array(planner.tip_pose(path.start).position)
    goal = np.array(planner.tip_pose(path.goal).position)
    along = (goal - start) / np.linalg.norm(goal - start)
    _, (position, _, _, _) = derivatives_between(time_parameterize(path, LIMITS), 10)
    for configuration in position:
        offset = np.array(planner.tip_pose(configuration).position) - start
        assert np.linalg.norm(offset - along * (offset @ along)) <= 2e-7


def test_trajectory_starts_and_ends_at_rest_on_the_waypoints() -> None:
    trajectory = time_parameterize(JointPath(JOINTS, ((HOME, GOAL), (GOAL, HOME))), LIMITS)
    first, last = trajectory.points[0], trajectory.points[-1]
    assert (first.time_from_start_ns, first.positions, last.positions) == (0, HOME, HOME)
    for point in (first, last):
        assert set(point.velocities) == set(point.accelerations) == {0.0}
    corner = [point for point in trajectory.points if point.positions == GOAL]
    assert len(corner) == 1
    assert set(corner[0].velocities) == {0.0}
    times = [point.time_from_start_ns for point in trajectory.points]
    assert min(np.diff(times)) >= 100_000


def test_single_joint_edge_takes_the_time_of_the_closed_form() -> None:
    # Long move of one joint: T = d/v + v/a + a/j (trapezoidal acceleration, all phases present).
    goal = (HOME[0] + 3.0, *HOME[1:])
    trajectory = time_parameterize(JointPath(JOINTS, ((HOME, goal),)), LIMITS.scaled(velocity=0.5))
    expected = 3.0 / (math.pi / 2) + (math.pi / 2) / 5.0 + 5.0 / 50.0
    assert trajectory.duration_ns * 1e-9 == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("jerk", [50.0, 500.0, 1_500.0, 5_000.0, 1e6])
def test_much_jerk_beside_little_acceleration_makes_no_motion_slower(jerk: float) -> None:
    # A tenth of the speed and acceleration of an arm: 1 rad at 0.1 rad/s and 0.15 rad/s^2 is 1 / 0.1 + 0.1 / 0.15 s and
    # a jerk phase, as long as acceleration over jerk. At 1,500 rad/s^3 that is the least time between two points.
    ends = tuple(0.0 for _ in JOINTS), (1.0, *(0.0 for _ in JOINTS[1:]))
    rows = tuple(tuple(value for _ in JOINTS) for value in (0.1, 0.15, jerk))
    path, limits = JointPath(JOINTS, (ends,)), JointLimits(JOINTS, LIMITS.lower, LIMITS.upper, *rows)
    timed = time_parameterize(path, limits)
    assert timed.duration_ns * 1e-9 == pytest.approx(1 / 0.1 + 0.1 / 0.15 + 0.15 / min(jerk, 1_500.0), rel=1e-3)
    _assert_within_limits(timed, limits)


def test_path_without_motion_is_one_point() -> None:
    trajectory = time_parameterize(JointPath(JOINTS, ((HOME, HOME),)), LIMITS)
    assert [point.positions for point in trajectory.points] == [HOME]
    assert trajectory.duration_ns == 0


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan, math.inf])
@pytest.mark.parametrize("kind", ["velocity", "acceleration", "jerk"])
def test_limit_that_ruckig_would_refuse_is_reported_by_joint(kind: str, bad: float) -> None:
    values = {"velocity": LIMITS.velocity, "acceleration": LIMITS.acceleration, "jerk": LIMITS.jerk}
    values[kind] = (*values[kind][:5], bad)
    with pytest.raises(LimitsError, match=f"joint `wrist_3` has the {kind} limit"):
        JointLimits(JOINTS, LIMITS.lower, LIMITS.upper, values["velocity"], values["acceleration"], values["jerk"])


def test_closed_form_of_a_duration_is_that_of_ruckig() -> None:
    # Over five decades each, so that every kind of law occurs: with and without full speed and full acceleration.
    bounds = 10.0 ** np.random.default_rng(8).uniform(-2.0, 3.0, size=(500, 3))
    expected = [rest_to_rest((velocity, acceleration, jerk)).duration for velocity, acceleration, jerk in bounds]
    np.testing.assert_allclose(rest_to_rest_durations(bounds), expected, rtol=1e-12)
