"""Reading robot descriptions: mimic joints, and a stated reason for every refusal."""

from __future__ import annotations

import math

import pytest

from cellc.robot.planning import CollisionScene, JointLimits, ModelError, Planner, PlanningGroup, RobotModel

from .arm import ADJACENT, HOME, JOINTS, arm_urdf

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
