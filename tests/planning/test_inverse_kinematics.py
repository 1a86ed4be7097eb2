"""Forward and inverse kinematics against DH matrices multiplied in the test."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from cellc.contract.transforms import Pose, from_xyz_rpy
from cellc.robot.planning import (
    CollisionScene,
    FailureReason,
    IkFailure,
    IkSolution,
    JointLimits,
    Planner,
    RobotModel,
)
from cellc.robot.planning.chain import GroupChain
from cellc.robot.planning.inverse_kinematics import Descent, descend, undo_turns
from cellc.robot.planning.model import from_pose

from .arm import ADJACENT, GROUP, HOME, JOINTS, LIMITS, arm_urdf, dh_singular_values, dh_tool_to_base


@pytest.fixture(name="planner")
def planner_fixture() -> Planner:
    model = RobotModel.from_urdf(arm_urdf())
    return Planner(model, GROUP, LIMITS, CollisionScene(model, disabled_collisions=ADJACENT))


def _matrix(pose: Pose) -> npt.NDArray[np.float64]:
    axes = np.array([pose.apply(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]) - np.array(pose.position)
    return np.vstack((np.column_stack((axes.T, pose.position)), (0, 0, 0, 1)))


def test_tip_pose_is_the_product_of_the_dh_matrices(planner: Planner) -> None:
    # A URDF base written from DH joint origins has no half turn against the DH base frame.
    for configuration in np.random.default_rng(1).uniform(-math.pi, math.pi, size=(100, 6)):
        np.testing.assert_allclose(
            _matrix(planner.tip_pose(configuration)), dh_tool_to_base(configuration), rtol=0.0, atol=1e-12
        )


def test_solution_reaches_the_target_by_dh(planner: Planner) -> None:
    solved = 0
    for wanted in np.random.default_rng(2).uniform(-1.5, 1.5, size=(30, 6)):
        target = planner.tip_pose(wanted)
        solution = planner.inverse_kinematics(target, HOME, seeds=12, rng_seed=3)
        if isinstance(solution, IkFailure):
            assert solution.reason in (FailureReason.GOAL_IN_COLLISION, FailureReason.SINGULAR)
            continue
        solved += 1
        difference = dh_tool_to_base(np.array(solution.configuration)) - _matrix(target)
        assert np.max(np.abs(difference[:3, 3])) <= 1e-5
        assert np.max(np.abs(difference[:3, :3])) <= 1e-4
        assert not LIMITS.violation(np.array(solution.configuration))
    assert solved >= 15


def test_nearest_solution_is_the_current_configuration_itself(planner: Planner) -> None:
    solution = planner.inverse_kinematics(planner.tip_pose(HOME), HOME)
    assert isinstance(solution, IkSolution)
    np.testing.assert_allclose(solution.configuration, HOME, atol=1e-6)


def test_whole_turns_are_kept_at_the_current_turn(planner: Planner) -> None:
    turned = (HOME[0], HOME[1], HOME[2], HOME[3], HOME[4], HOME[5] + 1.9 * math.pi)
    target = planner.tip_pose((*HOME[:5], HOME[5] - 0.1 * math.pi))
    solution = planner.inverse_kinematics(target, turned)
    assert isinstance(solution, IkSolution)
    np.testing.assert_allclose(solution.configuration, turned, atol=1e-6)


def test_turn_that_would_leave_the_limits_is_undone(planner: Planner) -> None:
    # From 1.9 pi the near way to 0.2 pi + 2 pi is beyond the limit of 2 pi: the far way within limits is the answer.
    current = (*HOME[:5], 1.9 * math.pi)
    solution = planner.inverse_kinematics(planner.tip_pose((*HOME[:5], 0.2 * math.pi)), current)
    assert isinstance(solution, IkSolution)
    assert all(abs(value) <= 2 * math.pi for value in solution.configuration)
    np.testing.assert_allclose(
        dh_tool_to_base(np.array(solution.configuration)),
        dh_tool_to_base(np.array((*HOME[:5], 0.2 * math.pi))),
        atol=1e-5,
    )


def test_whole_turns_lead_to_the_nearest_place_within_limits() -> None:
    # -1.8 pi is 0.2 pi and 2.2 pi: nearest to 1.9 pi would be 2.2 pi, which is past the limit of 2 pi.
    found = np.array((0.0, 0.0, 0.0, 0.0, 0.0, -1.8 * math.pi))
    near = undo_turns(found, np.array((0.0, 0.0, 0.0, 0.0, 0.0, 1.9 * math.pi)), LIMITS, np.full(6, True))
    np.testing.assert_allclose(near, (0.0, 0.0, 0.0, 0.0, 0.0, 0.2 * math.pi), atol=1e-12)
    kept = undo_turns(found, np.array((0.0, 0.0, 0.0, 0.0, 0.0, 1.9 * math.pi)), LIMITS, np.full(6, False))
    np.testing.assert_array_equal(kept, found)


def test_target_beyond_reach_has_no_solution(planner: Planner) -> None:
    failure = planner.inverse_kinematics(Pose((1.5, 0.0, 0.3), (0.0, 0.0, 0.0, 1.0)), HOME)
    assert isinstance(failure, IkFailure)
    assert failure.reason is FailureReason.NO_IK_SOLUTION


def test_target_below_the_table_is_in_collision(planner: Planner) -> None:
    failure = planner.inverse_kinematics(from_xyz_rpy((-0.45, -0.13, -0.05), (math.pi, 0.0, math.pi / 2)), HOME)
    assert isinstance(failure, IkFailure)
    assert failure.reason is FailureReason.GOAL_IN_COLLISION
    assert "`table`" in failure.detail


def test_target_reached_only_past_a_limit_is_out_of_limits() -> None:
    model = RobotModel.from_urdf(arm_urdf())
    width = 0.05
    limits = JointLimits(
        JOINTS,
        tuple(value - width for value in HOME),
        tuple(value + width for value in HOME),
        LIMITS.velocity,
        LIMITS.acceleration,
        LIMITS.jerk,
    )
    planner = Planner(model, GROUP, limits, CollisionScene(model, disabled_collisions=ADJACENT))
    target = planner.tip_pose((HOME[0] + 0.3, *HOME[1:]))
    failure = planner.inverse_kinematics(target, HOME)
    assert isinstance(failure, IkFailure)
    assert failure.reason is FailureReason.OUT_OF_LIMITS


def test_solution_with_the_arm_stretched_is_singular(planner: Planner) -> None:
    stretched = (0.3, -1.2, 0.0, -1.0, -1.2, 0.4)
    # With more seeds the same target is also reached with the wrist turned over and the elbow bent.
    failure = planner.inverse_kinematics(planner.tip_pose(stretched), stretched, seeds=1)
    assert isinstance(failure, IkFailure)
    assert failure.reason is FailureReason.SINGULAR


def test_manipulability_is_the_product_of_singular_values_of_a_numeric_jacobian(planner: Planner) -> None:
    solution = planner.inverse_kinematics(planner.tip_pose(HOME), HOME)
    assert isinstance(solution, IkSolution)
    values = dh_singular_values(np.array(solution.configuration))
    assert solution.min_singular_value == pytest.approx(values[-1], abs=1e-6)
    assert solution.manipulability == pytest.approx(np.prod(values), abs=1e-6)


def _counting(calls: list[int]) -> Callable[..., Descent]:
    def counted(*arguments: Any) -> Descent:
        calls.append(1)
        return descend(*arguments)

    return counted


def _nearest_of_many(planner: Planner, target: Pose, current: npt.NDArray[np.float64]) -> float:
    """Return the distance to the nearest free solution that 40 descents find, without the search that is tested."""
    chain = GroupChain(GROUP, planner.scene)
    wanted = from_pose(target)  # the base link of this arm stands in the origin of the world
    drawn = np.random.default_rng(7).uniform(-math.pi, math.pi, size=(39, 6))
    descents = [descend(chain, wanted, seed, LIMITS) for seed in (current, *drawn)]
    near = [undo_turns(each.configuration, current, LIMITS, chain.turning) for each in descents if each.reached]
    return min(float(np.linalg.norm(each - current)) for each in near if not chain.collides(each))


def test_search_that_ends_early_ends_at_the_nearest_solution(planner: Planner, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    monkeypatch.setattr("cellc.robot.planning.inverse_kinematics.descend", _counting(calls))
    early = 0
    generator = np.random.default_rng(6)
    for _ in range(60):
        current = np.array(HOME) + generator.normal(0.0, 0.5, 6)
        wanted = current + generator.normal(0.0, [0.4, 0.4, 0.4, 0.4, 0.4, 1.5])
        if GroupChain(GROUP, planner.scene).collides(wanted):
            continue
        calls.clear()
        solution = planner.inverse_kinematics(planner.tip_pose(wanted.tolist()), current.tolist())
        if not isinstance(solution, IkSolution) or len(calls) > 1:
            continue
        early += 1
        distance = float(np.linalg.norm(np.array(solution.configuration) - current))
        assert distance <= _nearest_of_many(planner, planner.tip_pose(wanted.tolist()), current) + 1e-6
    assert early >= 15


def test_solution_on_another_branch_does_not_end_the_search(planner: Planner, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    monkeypatch.setattr("cellc.robot.planning.inverse_kinematics.descend", _counting(calls))
    # Close to the wrist's singularity (wrist_2 at zero) the nearest solution lies on its other side.
    current, wanted = np.array([0.0, -1.2, 1.4, -1.0, -0.1, 0.0]), np.array([0.05, -1.2, 1.4, -1.0, 0.1, 0.0])
    solution = planner.inverse_kinematics(planner.tip_pose(wanted.tolist()), current.tolist())
    assert isinstance(solution, IkSolution)
    assert len(calls) == 8
    np.testing.assert_allclose(solution.configuration, wanted, atol=1e-6)
