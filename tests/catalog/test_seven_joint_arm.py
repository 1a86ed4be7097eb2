"""The seven-joint arm and its hand against the vendor's published figures, typed here from the documents."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellc.compiler.catalog.load import CatalogDevice, load_device
from cellc.compiler.catalog.starter import NamedDevice, starter_spec
from cellc.contract.vocabulary import Behavior, Distro
from cellc.robot.description.model import Box
from tests.catalog.chains import Matrix, transform

PI = math.pi
JOINTS = tuple(f"fr3_joint{number}" for number in range(1, 8))
# Craig's convention, FCI documentation: a(i-1), alpha(i-1), d(i).
DH = (
    (0.0, 0.0, 0.333),
    (0.0, -PI / 2, 0.0),
    (0.0, PI / 2, 0.316),
    (0.0825, PI / 2, 0.0),
    (-0.0825, -PI / 2, 0.384),
    (0.0, PI / 2, 0.0),
    (0.088, PI / 2, 0.0),
)
FLANGE = 0.107
LOWER = (-2.7437, -1.7837, -2.9007, -3.0421, -2.8065, 0.5445, -3.0159)
UPPER = (2.7437, 1.7837, 2.9007, -0.1518, 2.8065, 4.5169, 3.0159)
VELOCITY = (2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26)
TORQUE = (87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0)
MASSES = (2.3966, 2.92747, 2.93554, 2.24490, 2.61560, 2.32712, 1.81704, 0.62714)
GAINS = {"p": (600, 600, 600, 600, 250, 150, 50), "i": (0,) * 7, "d": (30, 30, 30, 30, 10, 10, 5)}


def _device(name: str) -> CatalogDevice:
    device = load_device(name).value
    assert device is not None
    return device


def _craig(a: float, alpha: float, d: float, theta: float) -> Matrix:
    # Craig, Introduction to Robotics, eq. 3.6: screw along x, then along z.
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array(
        [[ct, -st, 0, a], [st * ca, ct * ca, -sa, -sa * d], [st * sa, ct * sa, ca, ca * d], [0, 0, 0, 1]], dtype=float
    )


def test_forward_kinematics_is_that_of_the_published_parameters() -> None:
    description = _device("franka_fr3").description
    generator = np.random.default_rng(20250814)
    for configuration in generator.uniform(LOWER, UPPER, size=(100, 7)):
        expected = np.eye(4)
        for (a, alpha, d), theta in zip(DH, configuration, strict=True):
            expected = expected @ _craig(a, alpha, d, theta)
        expected = expected @ _craig(0.0, 0.0, FLANGE, 0.0)
        actual = transform(description, "fr3_link0", "fr3_link8", dict(zip(JOINTS, configuration, strict=True)))
        np.testing.assert_allclose(actual, expected, atol=1e-6)


def test_home_holds_the_flange_out_and_its_z_down() -> None:
    # By hand: about the common y axis the flange is turned by -45 + 135 + 90 = 180 deg against the base.
    device = _device("franka_fr3")
    assert device.model.home is not None
    home = {name: position.si for name, position in device.model.home.items()}
    np.testing.assert_allclose([home[name] for name in JOINTS], [0, -PI / 4, 0, -3 * PI / 4, 0, PI / 2, PI / 4])
    flange = transform(device.description, "fr3_link0", "fr3_link8", home)
    np.testing.assert_allclose(flange[:3, 2], [0, 0, -1], atol=1e-12)


def test_limits_are_the_documented_ones() -> None:
    device = _device("franka_fr3")
    for index, name in enumerate(JOINTS):
        joint = device.description.joint(name)
        assert joint is not None
        assert joint.limit is not None
        limit = joint.limit
        assert (limit.lower, limit.upper) == (LOWER[index], UPPER[index])
        assert (limit.velocity, limit.effort) == (VELOCITY[index], TORQUE[index])
        acceleration, jerk = device.model.limits.acceleration_of(name), device.model.limits.jerk_of(name)
        assert acceleration is not None
        assert jerk is not None
        assert (acceleration.value.si, jerk.value.si) == (10.0, 5000.0)


@pytest.mark.parametrize(("joint", "sign"), [("fr3_joint4", -1), ("fr3_joint6", 1)])
def test_zero_is_out_of_the_range_of_two_joints(joint: str, sign: int) -> None:
    found = _device("franka_fr3").description.joint(joint)
    assert found is not None
    assert found.limit is not None
    assert found.limit.lower is not None
    assert found.limit.upper is not None
    assert sign * found.limit.lower > 0
    assert sign * found.limit.upper > 0


def test_links_weigh_what_is_published() -> None:
    for index, mass in enumerate(MASSES):
        link = _device("franka_fr3").description.link(f"fr3_link{index}")
        assert link is not None
        assert link.inertial is not None
        assert link.inertial.mass == pytest.approx(mass, abs=5e-6)  # published with five figures there


def test_trajectories_on_the_robot_are_torques_with_the_shipped_gains() -> None:
    control = _device("franka_fr3").model.control
    assert control is not None
    assert control.hardware.real is not None
    commands = control.hardware.real.commands[Behavior.JOINT_TRAJECTORY]
    assert commands.interfaces == ("effort",)
    assert commands.parameters == {
        f"gains.{{prefix}}{joint}.{gain}": float(values[index])
        for gain, values in GAINS.items()
        for index, joint in enumerate(JOINTS)
    }


def test_hand_weighs_and_opens_as_published() -> None:
    hand = _device("franka_hand")
    masses = [link.inertial.mass for link in hand.description.links if link.inertial is not None]
    assert sorted(masses) == [0.0291, 0.0291, 0.6544]
    np.testing.assert_allclose(transform(hand.description, "fr3_hand", "fr3_hand_tcp", {})[:3, 3], [0, 0, 0.1034])


@pytest.mark.parametrize(("finger", "gap_mm"), [(0.0, 0.2), (0.02, 40.2), (0.04, 80.2)])
def test_jaws_part_by_twice_the_way_of_a_finger(finger: float, gap_mm: float) -> None:
    # 2 q, and 0.1 mm by which each pad stands back from the middle.
    hand = _device("franka_hand").description
    follower = hand.joint("fr3_finger_joint2")
    assert follower is not None
    assert follower.mimic is not None
    assert follower.mimic.joint == "fr3_finger_joint1"
    positions = {"fr3_finger_joint1": finger, "fr3_finger_joint2": finger * follower.mimic.multiplier}
    inner = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        link = hand.link(f"fr3_{side}finger")
        assert link is not None
        frame = transform(hand, "fr3_hand", link.name, positions)
        boxes = [(shape.pose.position[1], shape.geometry) for shape in link.collisions]
        sizes = [(center, box.size[1]) for center, box in boxes if isinstance(box, Box)]
        assert len(sizes) == len(boxes)
        # The right finger is turned by half a turn: its y points to the other side.
        inner.append(sign * min(sign * (frame[1, 3] + frame[1, 1] * center) - width / 2 for center, width in sizes))
    assert (inner[0] - inner[1]) * 1000 == pytest.approx(gap_mm, abs=1e-6)


def test_real_hand_is_moved_by_a_node_and_by_no_component() -> None:
    control = _device("franka_hand").model.control
    assert control is not None
    assert control.hardware.real is None
    assert [node.executable for node in _device("franka_hand").model.nodes] == ["franka_gripper_node"]


def _first_spec(model: str) -> str:
    return starter_spec("first", Distro.JAZZY, {"arm": NamedDevice(model, _device(model))}, "cell.schema.json")


def test_first_spec_of_the_arm_commands_what_a_mock_can_follow() -> None:
    text = starter_spec(
        "first", Distro.JAZZY, {"arm": NamedDevice("franka_fr3", _device("franka_fr3"))}, "cell.schema.json"
    )
    assert "type: joint_trajectory\n" in text
    assert "update_rate: 1000 Hz\n" in text
    assert "arm_group: 0 -45 0 -135 0 90 45 deg\n" in text


def test_first_spec_of_an_arm_with_fingers_has_a_controller_for_each_and_goes_aside() -> None:
    text = starter_spec(
        "first",
        Distro.JAZZY,
        {"arm": NamedDevice("kinova_gen3_2f_85", _device("kinova_gen3_2f_85"))},
        "cell.schema.json",
    )
    assert "    arm_trajectory:\n" in text
    assert "    arm_action: {type: parallel_gripper, device: arm}\n" in text
    assert "    aside:\n      arm_group: 20 14.8969 179.909 -130.061 0 55.0039 89.9544 deg\n" in text
    assert "{move: home}, {move: aside}, {grip: close}, {grip: open}, {move: home}" in text
