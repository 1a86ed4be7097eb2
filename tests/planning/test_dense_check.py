"""Planned motions are free of collision between the planner's own checks: every 1 mm and 0.1 degrees, pair by pair.

The cell is read and checked here by pinocchio alone, without the scene, its bounding boxes or its distances of checks.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pinocchio
import pytest

from cellc.contract.transforms import Pose
from cellc.robot.planning import (
    CollisionScene,
    IkSolution,
    JointLimits,
    JointPath,
    Planner,
    RobotModel,
    TimedTrajectory,
    time_parameterize,
)

from .arm import ADJACENT, GROUP, HOME, JOINTS, LIMITS, arm_urdf, dh_tool_to_base
from .interpolation import derivatives_between

DOWN = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
WALL = """
<link name="wall"><collision><geometry><box size="0.5 0.02 0.5"/></geometry></collision></link>
<joint name="wall_mount" type="fixed"><parent link="table"/><child link="wall"/><origin xyz="-0.5 0 0.25"/></joint>
"""
STEP_M = 0.001
STEP_RAD = math.radians(0.1)
REACH_M = 1.2
"""Of the tip from any joint."""


def _free(urdf: str, configurations: npt.NDArray[np.float64]) -> bool:
    model = pinocchio.buildModelFromXML(urdf)
    shapes = pinocchio.buildGeomFromUrdfString(model, urdf, pinocchio.GeometryType.COLLISION)
    links = [model.frames[shape.parentFrame].name for shape in shapes.geometryObjects]
    bodies = [shape.parentJoint for shape in shapes.geometryObjects]
    for first in range(len(links)):
        for second in range(first + 1, len(links)):
            near = {(links[first], links[second]), (links[second], links[first])} & set(ADJACENT)
            if not near and bodies[first] != bodies[second]:
                shapes.addCollisionPair(pinocchio.CollisionPair(first, second))
    data, placed = model.createData(), shapes.createData()
    places = [model.idx_qs[model.getJointId(joint)] for joint in JOINTS]
    for configuration in configurations:
        full = pinocchio.neutral(model)
        full[places] = configuration
        if pinocchio.computeCollisions(model, data, shapes, placed, full, False):
            return False
    return True


def _dense(trajectory: TimedTrajectory) -> npt.NDArray[np.float64]:
    """Sample what the controller commands, so densely that no joint and no tip goes farther than a step."""
    longest = max(
        last.time_from_start_ns - first.time_from_start_ns
        for first, last in zip(trajectory.points[:-1], trajectory.points[1:], strict=True)
    )
    # At 3.15 rad/s and with 1.2 m of reach the tip goes at up to 4 m/s.
    samples = math.ceil(longest * 1e-9 * max(max(LIMITS.velocity) / STEP_RAD, 4.0 / STEP_M))
    return _thinned(derivatives_between(trajectory, samples)[1][0])


def _thinned(configurations: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Leave out what lies within a step of its neighbours: most of the time no joint runs at its highest speed."""
    moved = np.abs(np.diff(configurations, axis=0))
    steps = np.maximum(moved.max(axis=1) / STEP_RAD, REACH_M * moved.sum(axis=1) / STEP_M)
    kept, since = [0], 0.0
    for index, step in enumerate(steps.tolist()):
        if since + step > 1.0 and index > kept[-1]:
            kept.append(index)
            since = 0.0
        since += step
    return configurations[[*kept, len(configurations) - 1]]


def _motion(seed: int, limits: JointLimits) -> tuple[str, TimedTrajectory]:
    urdf = arm_urdf(WALL)
    model = RobotModel.from_urdf(urdf)
    planner = Planner(model, GROUP, limits, CollisionScene(model, disabled_collisions=ADJACENT))
    generator = np.random.default_rng(seed)
    solutions = []
    for side in (-1.0, 1.0):
        x, y, z = generator.uniform((-0.5, 0.25, 0.2), (-0.4, 0.35, 0.3)) * (1.0, side, 1.0)
        solution = planner.inverse_kinematics(Pose((x, y, z), DOWN), HOME, rng_seed=seed)
        assert isinstance(solution, IkSolution)
        solutions.append(solution.configuration)
    transit = planner.plan_to_configuration(*solutions, rng_seed=seed)
    assert isinstance(transit, JointPath)
    x, y, z = planner.tip_pose(transit.goal).position
    line = planner.plan_cartesian(transit.goal, Pose((x, y + 0.1, z), DOWN))
    assert isinstance(line, JointPath)
    return urdf, time_parameterize(transit.then(line), limits)


@pytest.mark.parametrize("seed", range(4))
def test_motion_round_a_wall_touches_nothing_between_checks(seed: int) -> None:
    urdf, trajectory = _motion(seed, LIMITS)
    configurations = _dense(trajectory)
    assert np.max(np.abs(np.diff(configurations, axis=0))) <= STEP_RAD
    tips = np.array([dh_tool_to_base(each)[:3, 3] for each in configurations])
    assert np.max(np.linalg.norm(np.diff(tips, axis=0), axis=1)) <= STEP_M
    assert _free(urdf, configurations)


def test_check_of_this_test_meets_the_wall() -> None:
    # The planner knows of no wall here, and goes straight through where it stands.
    model = RobotModel.from_urdf(arm_urdf())
    planner = Planner(model, GROUP, LIMITS, CollisionScene(model, disabled_collisions=ADJACENT))
    left, right = (planner.inverse_kinematics(Pose((-0.45, y, 0.25), DOWN), HOME) for y in (-0.3, 0.3))
    assert isinstance(left, IkSolution)
    assert isinstance(right, IkSolution)
    path = planner.plan_to_configuration(left.configuration, right.configuration)
    assert isinstance(path, JointPath)
    assert not _free(arm_urdf(WALL), _dense(time_parameterize(path, LIMITS)))
