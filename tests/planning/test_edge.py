"""How densely edges are checked: against points that pinocchio moves, and against an obstacle thinner than a step."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pinocchio
import pytest

from cellc.contract.transforms import Pose
from cellc.robot.planning import CollisionScene, PlanningGroup, RobotModel
from cellc.robot.planning.chain import GroupChain
from cellc.robot.planning.rrt_connect import EDGE_RESOLUTION_M, edge_is_free
from tests.planning.arm import ADJACENT, GROUP, LIMITS, arm_urdf

UPRIGHT = (0.0, 0.0, 0.0, 1.0)

# The bar is 2 m long and 6 mm thick, the pin near its end 6 mm: they touch over 12 mm of the way of the end.
BAR = """
<robot name="bar">
  <link name="world"/>
  <link name="bar"><collision><origin xyz="1 0 0"/><geometry><box size="2 0.006 0.006"/></geometry></collision></link>
  <link name="pin"><collision><geometry><box size="0.006 0.006 0.006"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="world"/><child link="bar"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="pin_mount" type="fixed"><parent link="world"/><child link="pin"/>
    <origin xyz="{x} {y} 0" rpy="0 0 {angle}"/></joint>
</robot>
"""

# A finger of 0.1 m slides up to 0.3 m away from a turning hand, and another follows it twice as far.
FINGERS = """
<robot name="fingers">
  <link name="world"/>
  <link name="hand"/>
  <link name="finger"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="twin"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="world"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="hand"/><child link="finger"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.3" velocity="1" effort="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="hand"/><child link="twin"/><axis xyz="-1 0 0"/>
    <limit lower="0" upper="1" velocity="1" effort="1"/><mimic joint="slide" multiplier="2"/></joint>
</robot>
"""


def _corners(model: RobotModel, scene: CollisionScene, full: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the corners of the boxes around all shapes in the world, shape (corners, 3)."""
    geometry, data = scene._geometry, model.kinematics.createData()
    placed = geometry.createData()
    pinocchio.updateGeometryPlacements(model.kinematics, data, geometry, placed, full)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    found = []
    for shape, place in zip(geometry.geometryObjects, placed.oMg, strict=True):
        shape.geometry.computeLocalAABB()
        box = shape.geometry.aabb_local
        half = (np.asarray(box.max_) - np.asarray(box.min_)) / 2.0
        found.append((np.asarray(box.center()) + signs * half) @ place.rotation.T + place.translation)
    return np.concatenate(found)


@pytest.mark.parametrize("spread", [0.05, 0.5, 3.0])
def test_no_point_moves_farther_than_the_bound(spread: float) -> None:
    model = RobotModel.from_urdf(arm_urdf())
    scene = CollisionScene(model, disabled_collisions=ADJACENT)
    scene = scene.attach("part", "tool", (0.05, 0.1, 0.2), Pose((0.02, 0.0, 0.1), UPRIGHT))
    chain = GroupChain(GROUP, scene)
    generator = np.random.default_rng(11)
    for _ in range(100):
        start = generator.uniform(LIMITS.lower, LIMITS.upper)
        difference = generator.normal(0.0, spread, 6) * generator.integers(0, 2, 6)
        moved = _corners(model, scene, chain.full(start + difference)) - _corners(model, scene, chain.full(start))
        assert np.max(np.linalg.norm(moved, axis=1)) <= chain.sweeps_m(difference[np.newaxis])[0] + 1e-9


def test_bound_of_one_joint_is_the_distance_that_a_stretched_arm_reaches() -> None:
    # The UR5e's 0.425 + 0.3922 + 0.0997 + 0.04 m (half a flange) lie between shoulder and the last cylinder's rim.
    chain = GroupChain(GROUP, CollisionScene(RobotModel.from_urdf(arm_urdf())))
    assert 0.95 < chain.sweeps_m(np.array([[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]))[0] < 1.2
    assert chain.sweeps_m(np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]))[0] == pytest.approx(
        math.hypot(0.04, 0.04) * 1.2, rel=0.3
    )


def test_bound_counts_the_way_of_sliding_joints_and_of_those_that_follow() -> None:
    model = RobotModel.from_urdf(FINGERS)
    turning = GroupChain(PlanningGroup("hand", ("turn",), "world", "hand"), CollisionScene(model))
    # The twin's centre is at most 0.6 m out; a ball round a ball of 0.1 m adds its own box's half diagonal.
    assert 0.7 <= turning.sweeps_m(np.array([[1.0]]))[0] < 0.8
    sliding = GroupChain(PlanningGroup("hand", ("slide",), "world", "hand"), CollisionScene(model))
    assert sliding.sweeps_m(np.array([[0.1]]))[0] == pytest.approx(0.2)


@pytest.mark.parametrize("degrees", range(5, 50, 3))
def test_obstacle_of_a_step_is_met_wherever_it_stands(degrees: int) -> None:
    angle = math.radians(degrees) + 0.0007
    model = RobotModel.from_urdf(BAR.format(x=1.99 * math.cos(angle), y=1.99 * math.sin(angle), angle=angle))
    chain = GroupChain(PlanningGroup("bar", ("turn",), "world", "bar"), CollisionScene(model))
    assert EDGE_RESOLUTION_M <= 0.012
    assert not edge_is_free(chain, np.array([0.0]), np.array([1.0]))
    assert edge_is_free(chain, np.array([0.0]), np.array([angle - 0.01]))
