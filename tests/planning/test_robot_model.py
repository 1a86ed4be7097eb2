"""Reading robot descriptions, of the catalog too: mimic joints, meshes, and a reason for every refusal."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest
import xacro

from cellc.contract.transforms import Pose, from_xyz_rpy
from cellc.robot.description.packages import on_package_path
from cellc.robot.planning import (
    CollisionScene,
    JointLimits,
    JointPath,
    ModelError,
    Planner,
    PlanningGroup,
    RobotModel,
    disabled_collisions,
    time_parameterize,
)
from tests.cells import catalog_facts

from .arm import ADJACENT, HOME, JOINTS, arm_urdf, dh_tool_to_base

# The follower sorts before its leader by name, which pinocchio's own mimic support refuses.
GRIPPER = """
<link name="palm"/><link name="left"/><link name="right"/>
<joint name="palm_mount" type="fixed"><parent link="tool"/><child link="palm"/></joint>
<joint name="leader" type="revolute"><parent link="palm"/><child link="left"/><axis xyz="1 0 0"/>
  <origin xyz="0 0 0.1"/><limit lower="0" upper="0.8" velocity="1" effort="1"/></joint>
<joint name="follower" type="revolute"><parent link="left"/><child link="right"/><axis xyz="1 0 0"/>
  <limit lower="-2" upper="2" velocity="1" effort="1"/><mimic joint="leader" multiplier="-2" offset="0.1"/></joint>
"""
MESH = '<mesh filename="package://no/x.stl"/>'


def _at_home(model: RobotModel) -> CollisionScene:
    return CollisionScene(model, disabled_collisions=ADJACENT, other_positions=dict(zip(JOINTS, HOME, strict=True)))


def test_mimic_joint_is_no_joint_of_its_own() -> None:
    model = RobotModel.from_urdf(arm_urdf(GRIPPER))
    assert model.joints == ("pan", "lift", "elbow", "wrist_1", "wrist_2", "wrist_3", "leader")


def test_mimic_joint_follows_by_multiplier_and_offset() -> None:
    model = RobotModel.from_urdf(arm_urdf(GRIPPER))
    roll, pitch, yaw = model.link_pose("right", {"leader": 0.5}, base_link="palm").rpy()
    assert (roll, pitch, yaw) == pytest.approx((0.5 + (-2.0 * 0.5 + 0.1), 0.0, 0.0), abs=1e-12)


def test_mimic_of_a_mimic_follows_the_first_leader() -> None:
    chained = GRIPPER + (
        '<link name="last"/><joint name="a_third" type="revolute"><parent link="palm"/><child link="last"/>'
        '<axis xyz="1 0 0"/><limit lower="-9" upper="9" velocity="1" effort="1"/>'
        '<mimic joint="follower" multiplier="3" offset="-0.2"/></joint>'
    )
    model = RobotModel.from_urdf(arm_urdf(chained))
    roll = model.link_pose("last", {"leader": 0.5}, base_link="palm").rpy()[0]
    assert roll == pytest.approx(3.0 * (-2.0 * 0.5 + 0.1) - 0.2, abs=1e-12)


def test_jacobian_of_a_chain_over_a_mimic_joint_counts_both_joints() -> None:
    model = RobotModel.from_urdf(arm_urdf(GRIPPER))
    limits = JointLimits(("leader",), (0.0,), (0.8,), (1.0,), (1.0,), (1.0,))
    planner = Planner(model, PlanningGroup("finger", ("leader",), "palm", "right"), limits, _at_home(model))
    turned = planner.tip_pose((0.3,))
    assert turned.rpy()[0] == pytest.approx(0.3 - 2.0 * 0.3 + 0.1, abs=1e-12)
    solution = planner.inverse_kinematics(turned, (0.0,), seeds=1)
    assert getattr(solution, "configuration", None) == pytest.approx((0.3,), abs=1e-9)


def test_continuous_joint_is_read_as_an_angle() -> None:
    wheel = (
        '<link name="wheel"/><joint name="spin" type="continuous"><parent link="table"/><child link="wheel"/>'
        '<axis xyz="0 0 1"/><limit velocity="1" effort="1"/></joint>'
    )
    model = RobotModel.from_urdf(arm_urdf(wheel))
    assert model.link_pose("wheel", {"spin": 2.0}, base_link="table").rpy()[2] == pytest.approx(2.0, abs=1e-12)
    limits = JointLimits(("spin",), (-math.inf,), (math.inf,), (1.0,), (1.0,), (1.0,))
    planner = Planner(model, PlanningGroup("wheel", ("spin",), "table", "wheel"), limits, _at_home(model))
    solution = planner.inverse_kinematics(planner.tip_pose((0.5,)), (12.0,))
    assert getattr(solution, "configuration", None) == pytest.approx((0.5 + 4.0 * math.pi,), abs=1e-6)


def test_joint_at_rest_outside_zero_stands_at_its_nearest_limit() -> None:
    slide = (
        '<link name="slide"/><joint name="rail" type="prismatic"><parent link="table"/><child link="slide"/>'
        '<axis xyz="0 0 1"/><limit lower="0.2" upper="0.9" velocity="1" effort="1"/></joint>'
    )
    model = RobotModel.from_urdf(arm_urdf(slide))
    assert model.link_pose("slide", {}, base_link="table").position == pytest.approx((0.0, 0.0, 0.2))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<robot", "not well-formed XML"),
        ("<cell/>", "the root element is `<cell>`, a URDF begins with `<robot>`"),
        ("<robot name='x'/>", "has no link"),
        (arm_urdf('<link name="base"/>'), "link `base` is declared twice"),
        (arm_urdf('<link name="loose"/>'), "exactly one root, found `table`, `loose`"),
        (arm_urdf().replace('name="elbow" type="revolute"', 'name="elbow" type="hinge"'), "unknown type `hinge`"),
        (arm_urdf().replace('<parent link="link_2"/>', '<parent link="nowhere"/>'), "parent link `nowhere`"),
        (arm_urdf(GRIPPER.replace('mimic joint="leader"', 'mimic joint="lead"')), "mimics `lead`, which does not"),
        (arm_urdf(GRIPPER.replace('mimic joint="leader"', 'mimic joint="mount"')), "mimics `mount`, which is fixed"),
        (arm_urdf(GRIPPER.replace('mimic joint="leader"', 'mimic joint="follower"')), "mimics itself"),
        (arm_urdf(GRIPPER.replace('multiplier="-2"', 'multiplier="two"')), "`two` in `multiplier` of `<mimic>`"),
        (arm_urdf().replace('<cylinder length="0.04" radius="0.04"/>', MESH), "x.stl"),
    ],
)
def test_refused_description_gives_its_reason_in_one_line_and_prints_nothing(
    text: str, reason: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(ModelError, match=reason) as caught:
        RobotModel.from_urdf(text)
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_group_with_an_unknown_joint_is_refused() -> None:
    model = RobotModel.from_urdf(arm_urdf())
    limits = JointLimits(("knee",), (0.0,), (1.0,), (1.0,), (1.0,), (1.0,))
    with pytest.raises(ModelError, match="no independent movable joint `knee`"):
        Planner(model, PlanningGroup("leg", ("knee",), "base", "tool"), limits)


CORNERS = ((0, 0, 0), (0.1, 0, 0), (0, 0.2, 0), (0, 0, 0.3))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
ROBOT = """<robot name="r"><link name="base">
<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
<collision><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/>
<geometry><mesh filename="package://parts/a.stl" scale="2 -1 0.5"/></geometry></collision>
</link><link name="a_1"><visual><geometry><mesh filename="package://absent/b.dae"/></geometry></visual>
<collision><geometry><mesh filename="package://parts/b.obj"/></geometry></collision>
<collision><geometry><sphere radius="0.1"/></geometry></collision>
<collision><geometry><mesh filename="package://parts/a.stl"/></geometry></collision></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="a_1"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""


@pytest.fixture(name="shelf")
def shelf_fixture(tmp_path: Path) -> Iterator[Path]:
    parts = tmp_path / "parts"
    parts.mkdir()
    triangles = [[value for corner in face for value in CORNERS[corner]] for face in FACES]
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *values, 0) for values in triangles)
    (parts / "a.stl").write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + body)
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    (parts / "b.obj").write_text("mtllib absent.mtl\n" + "\n".join(lines) + "\n")
    with on_package_path([str(tmp_path)]):
        yield tmp_path


def _shown(geometry: Any) -> list[tuple[object, ...]]:
    shapes: list[tuple[object, ...]] = []
    for each in geometry.geometryObjects:
        placement = np.asarray(each.placement.homogeneous).round(12).tolist()
        shape = each.geometry
        numbers: object = None
        if hasattr(shape, "num_tris"):
            corners = [tuple(shape.tri_indices(row)[at] for at in range(3)) for row in range(shape.num_tris)]
            numbers = (np.asarray(shape.vertices()).tolist(), corners, shape.getNumBVs())
        shapes.append((each.name, each.parentFrame, each.parentJoint, placement, shape.getNodeType(), numbers))
    return shapes


def test_shapes_are_those_that_pinocchio_reads_from_the_files(shelf: Path) -> None:
    model = pinocchio.buildModelFromXML(ROBOT)
    expected = pinocchio.buildGeomFromUrdfString(model, ROBOT, pinocchio.GeometryType.COLLISION, None, [str(shelf)])
    found = RobotModel.from_urdf(ROBOT).geometry
    assert _shown(found) == _shown(expected)
    assert sum(entry[-1] is not None for entry in _shown(found)) == 3


DEVICES = Path(__file__).resolve().parents[2] / "cellc" / "compiler" / "catalog" / "devices"
ARM = DEVICES / "universal_robots" / "ur.urdf.xacro"
TWO_FINGERS = DEVICES / "robotiq" / "robotiq_2f_85.urdf.xacro"
ARM_HOME = (0.0, -1.57, 1.57, -1.57, -1.57, 0.0)


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
    above = planner.tip_pose(ARM_HOME)
    x, y, z = above.position
    down = planner.plan_cartesian(ARM_HOME, Pose((x, y, z - 0.15), above.quaternion))
    assert isinstance(down, JointPath)
    back = planner.plan_cartesian(down.goal, above)
    assert isinstance(back, JointPath)
    use = time_parameterize(down.then(back), planner.limits).limit_use
    assert 0.999 <= use.as_speed <= 1.0
    np.testing.assert_allclose(back.goal, ARM_HOME, atol=1e-6)


def test_followers_of_the_gripper_close_with_their_leader() -> None:
    model = RobotModel.from_urdf(_expanded(TWO_FINGERS, "robotiq_2f_85"))
    (leader,) = model.joints
    root = model.links[0]
    for angle in (0.0, 0.4, 0.79):
        sides = [
            model.link_pose(f"robotiq_85_{side}_finger_tip_link", {leader: angle}, base_link=root)
            for side in ("left", "right")
        ]
        turn = from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, math.pi))
        np.testing.assert_allclose(turn.apply(sides[0].position), sides[1].position, atol=1e-9)
