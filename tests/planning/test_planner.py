"""Paths: straight, around a wall, along a line, and every reason for which there is none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellc.contract.transforms import Pose, from_xyz_rpy
from cellc.robot.planning import (
    CollisionScene,
    FailureReason,
    IkSolution,
    JointPath,
    LimitsError,
    PlanFailure,
    Planner,
    PlanningGroup,
    RobotModel,
)

from .arm import ADJACENT, GROUP, HOME, JOINTS, LIMITS, arm_urdf, dh_singular_values, dh_tool_to_base

DOWN = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
LEFT = Pose((-0.45, -0.35, 0.25), DOWN)
RIGHT = Pose((-0.45, 0.35, 0.25), DOWN)


@pytest.fixture(name="scene")
def scene_fixture() -> CollisionScene:
    return CollisionScene(RobotModel.from_urdf(arm_urdf()), disabled_collisions=ADJACENT)


@pytest.fixture(name="planner")
def planner_fixture(scene: CollisionScene) -> Planner:
    return Planner(scene.model, GROUP, LIMITS, scene)


def _walled(planner: Planner, height: float) -> Planner:
    wall = Pose((-0.5, 0.0, height / 2), (0.0, 0.0, 0.0, 1.0))
    return planner.in_scene(planner.scene.attach("wall", "table", (0.5, 0.02, height), wall))


def _configuration(planner: Planner, target: Pose) -> tuple[float, ...]:
    solution = planner.inverse_kinematics(target, HOME)
    assert isinstance(solution, IkSolution)
    return solution.configuration


def _refused(result: JointPath | PlanFailure) -> FailureReason:
    assert isinstance(result, PlanFailure)
    return result.reason


def test_free_edge_is_planned_straight(planner: Planner) -> None:
    goal = _configuration(planner, LEFT)
    path = planner.plan_to_configuration(HOME, goal)
    assert path == JointPath(JOINTS, ((HOME, goal),))


def test_wall_is_passed_without_touching_it(planner: Planner) -> None:
    walled = _walled(planner, 0.5)
    start, goal = _configuration(walled, LEFT), _configuration(walled, RIGHT)
    path = walled.plan_to_configuration(start, goal, rng_seed=7)
    assert isinstance(path, JointPath)
    assert (path.start, path.goal) == (start, goal)
    assert 2 <= len(path.sections) <= 8
    model = walled.model
    for first, last in path.sections:
        for fraction in np.linspace(0.0, 1.0, 700):
            between = (1.0 - fraction) * np.array(first) + fraction * np.array(last)
            positions = dict(zip(JOINTS, between.tolist(), strict=True))
            assert not walled.scene.collides(model.configuration(positions))
    for before, after in zip(path.sections[:-1], path.sections[1:], strict=True):
        assert before[-1] == after[0]


def test_goal_walled_in_has_no_path(planner: Planner) -> None:
    start, goal = _configuration(planner, LEFT), _configuration(planner, RIGHT)
    result = _walled(planner, 0.5).plan_to_configuration(start, goal, max_iterations=1)
    assert _refused(result) is FailureReason.NO_PATH


def test_ends_in_collision_are_told_apart(planner: Planner) -> None:
    through_table = (0.0, 0.6, 0.0, 0.0, 0.0, 0.0)
    assert _refused(planner.plan_to_configuration(HOME, through_table)) is FailureReason.GOAL_IN_COLLISION
    result = planner.plan_to_configuration(through_table, HOME)
    assert _refused(result) is FailureReason.START_IN_COLLISION
    assert isinstance(result, PlanFailure)
    assert "`table`" in result.detail


def test_goal_outside_position_limits_is_out_of_limits(planner: Planner) -> None:
    result = planner.plan_to_configuration(HOME, (*HOME[:2], 3.2, *HOME[3:]))
    assert _refused(result) is FailureReason.OUT_OF_LIMITS
    assert isinstance(result, PlanFailure)
    assert result.detail == "goal: joint `elbow` at 3.2 is outside -3.14159 to 3.14159"


def test_line_leads_the_tip_straight_in_steps_of_5_mm(planner: Planner) -> None:
    start = _configuration(planner, LEFT)
    path = planner.plan_cartesian(start, Pose((-0.45, -0.35, 0.15), DOWN))
    assert isinstance(path, JointPath)
    waypoints = [dh_tool_to_base(np.array(point)) for point in path.sections[0]]
    assert len(waypoints) == 21
    heights = [matrix[2, 3] for matrix in waypoints]
    np.testing.assert_allclose(np.diff(heights), -0.005, atol=1e-6)
    for matrix in waypoints:
        np.testing.assert_allclose(matrix[:2, 3], (-0.45, -0.35), atol=1e-6)
        np.testing.assert_allclose(matrix[:3, :3], waypoints[0][:3, :3], atol=1e-5)


def test_turn_on_the_spot_takes_steps_of_50_mrad(planner: Planner) -> None:
    path = planner.plan_cartesian(HOME, planner.tip_pose((*HOME[:5], HOME[5] + 1.0)))
    assert isinstance(path, JointPath)
    assert len(path.sections[0]) == 21
    np.testing.assert_allclose(path.goal, (*HOME[:5], HOME[5] + 1.0), atol=1e-6)


def test_line_into_the_table_has_no_path(planner: Planner) -> None:
    start = _configuration(planner, LEFT)
    assert _refused(planner.plan_cartesian(start, Pose((-0.45, -0.35, -0.1), DOWN))) is FailureReason.NO_PATH


@pytest.mark.parametrize(("depth", "steps"), [(-0.098, 70), (-1.248, 300)])
def test_line_is_refused_for_what_it_meets_first(planner: Planner, depth: float, steps: int) -> None:
    # The flange ends where the tip is: from 0.25 m up it meets the table within the step that passes z = 0. The longer
    # line would leave the reach of the arm later on.
    result = planner.plan_cartesian(_configuration(planner, LEFT), Pose((-0.45, -0.35, depth), DOWN))
    assert isinstance(result, PlanFailure)
    step = math.ceil(0.25 / ((0.25 - depth) / steps))
    assert result == PlanFailure(
        FailureReason.NO_PATH, f"at {step / steps:.0%} of the line: `link_6` and `table` touch"
    )


def test_line_out_of_reach_leaves_the_line_or_meets_the_stretched_arm(planner: Planner) -> None:
    start = _configuration(planner, LEFT)
    reason = _refused(planner.plan_cartesian(start, Pose((-1.4, -0.35, 0.25), DOWN)))
    assert reason in (FailureReason.SINGULAR, FailureReason.NO_IK_SOLUTION)


def test_line_past_a_joint_limit_is_out_of_limits(planner: Planner) -> None:
    near_limit = (*HOME[:5], 2 * math.pi - 0.1)
    result = planner.plan_cartesian(near_limit, planner.tip_pose((*HOME[:5], 0.1)))
    assert _refused(result) is FailureReason.OUT_OF_LIMITS


def test_turn_past_the_stretched_wrist_jumps(planner: Planner) -> None:
    # With wrist 2 at 0.1 rad, 0.05 rad about the tool's x ask wrist 1 and 3 for about 0.05 / sin(0.1) = 0.5 rad.
    start = (*HOME[:4], 0.1, 0.0)
    turn = from_xyz_rpy((0.0, 0.0, 0.0), (0.6, 0.0, 0.0))
    assert _refused(planner.plan_cartesian(start, planner.tip_pose(start) @ turn)) is FailureReason.JOINT_JUMP


def test_turn_through_the_stretched_wrist_is_singular(planner: Planner) -> None:
    # The tool's y is the axis of wrist 2 here: the turn takes it from 0.1 rad through 0.
    start = (*HOME[:4], 0.1, 0.0)
    turn = from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.6, 0.0))
    assert _refused(planner.plan_cartesian(start, planner.tip_pose(start) @ turn)) is FailureReason.SINGULAR


def test_limits_of_other_joints_are_refused(scene: CollisionScene) -> None:
    with pytest.raises(LimitsError, match="the limits are for"):
        Planner(scene.model, PlanningGroup("arm", JOINTS[:5], "base", "tool"), LIMITS, scene)


def test_targets_are_in_the_frame_of_the_base_link(scene: CollisionScene) -> None:
    wrist = PlanningGroup("arm", JOINTS, "table", "link_6")
    moved = arm_urdf().replace(
        '<joint name="mount" type="fixed">', '<joint name="mount" type="fixed"><origin xyz="0.3 0 0.02"/>'
    )
    scene = CollisionScene(RobotModel.from_urdf(moved), disabled_collisions=ADJACENT)
    seen = Planner(scene.model, wrist, LIMITS, scene).tip_pose(HOME).position
    expected = dh_tool_to_base(np.array(HOME))[:3, 3] + (0.3, 0.0, 0.02)
    np.testing.assert_allclose(seen, expected, atol=1e-12)


def test_distance_from_a_singularity_is_the_least_singular_value(planner: Planner) -> None:
    for configuration in (HOME, (0.3, -1.2, 0.4, -1.0, -1.2, 0.4)):
        values = dh_singular_values(np.array(configuration))
        assert planner.min_singular_value(configuration) == pytest.approx(values[-1], abs=1e-6)
    assert planner.min_singular_value((0.3, -1.2, 0.0, -1.0, -1.2, 0.4)) == pytest.approx(0.0, abs=1e-6)  # stretched
