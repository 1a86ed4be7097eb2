"""The planner on a device description of the catalog, as xacro itself expands it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import xacro

from cellc.contract.transforms import Pose, from_xyz_rpy
from cellc.robot.planning import (
    CollisionScene,
    JointLimits,
    JointPath,
    Planner,
    PlanningGroup,
    RobotModel,
    disabled_collisions,
    time_parameterize,
)
from tests.cells import catalog_facts

from .arm import dh_tool_to_base

DEVICES = Path(__file__).resolve().parents[2] / "cellc" / "compiler" / "catalog" / "devices"
ARM = DEVICES / "universal_robots" / "ur.urdf.xacro"
GRIPPER = DEVICES / "robotiq" / "robotiq_2f_85.urdf.xacro"
HOME = (0.0, -1.57, 1.57, -1.57, -1.57, 0.0)


def _expanded(path: Path, model: str) -> str:
    arguments = catalog_facts(model)["description"].get("arguments", {})
    return str(xacro.process_file(str(path), mappings=arguments).toxml())


@pytest.fixture(name="planner", scope="module")
def planner_fixture() -> Planner:
    model = RobotModel.from_urdf(_expanded(ARM, "ur5e"))
    limits = JointLimits(
        model.joints,
        tuple(-math.pi if joint == "elbow_joint" else -2 * math.pi for joint in model.joints),
        tuple(math.pi if joint == "elbow_joint" else 2 * math.pi for joint in model.joints),
        (math.pi,) * 6,
        (5.0,) * 6,
        (50.0,) * 6,
    )
    disabled = [pair.links for pair in disabled_collisions(model, samples=100, rng_seed=1, margin_m=0.005)]
    group = PlanningGroup("manipulator", model.joints, "base", "tool0")
    return Planner(model, group, limits, CollisionScene(model, disabled_collisions=disabled))


def test_tool_is_where_the_published_dh_parameters_put_it(planner: Planner) -> None:
    for configuration in np.random.default_rng(1).uniform(-math.pi, math.pi, size=(100, 6)):
        np.testing.assert_allclose(
            planner.tip_pose(configuration).position, dh_tool_to_base(configuration)[:3, 3], rtol=0.0, atol=1e-6
        )


def test_approach_and_retreat_keep_the_limits(planner: Planner) -> None:
    above = planner.tip_pose(HOME)
    x, y, z = above.position
    down = planner.plan_cartesian(HOME, Pose((x, y, z - 0.15), above.quaternion))
    assert isinstance(down, JointPath)
    back = planner.plan_cartesian(down.goal, above)
    assert isinstance(back, JointPath)
    use = time_parameterize(down.then(back), planner.limits).limit_use
    assert 0.999 <= use.as_speed <= 1.0
    np.testing.assert_allclose(back.goal, HOME, atol=1e-6)


def test_followers_of_the_gripper_close_with_their_leader() -> None:
    model = RobotModel.from_urdf(_expanded(GRIPPER, "robotiq_2f_85"))
    (leader,) = model.joints
    root = model.links[0]
    for angle in (0.0, 0.4, 0.79):
        sides = [
            model.link_pose(f"robotiq_85_{side}_finger_tip_link", {leader: angle}, base_link=root)
            for side in ("left", "right")
        ]
        turn = from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, math.pi))
        np.testing.assert_allclose(turn.apply(sides[0].position), sides[1].position, atol=1e-9)
