"""What robots of the catalog are, against what their vendors publish: poses, inertias, reach, limits, gains."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest

from cellc.compiler.catalog.compiled import compiled_device
from cellc.compiler.catalog.load import device_names
from cellc.compiler.catalog.starter import NamedDevice, starter_spec
from cellc.contract.vocabulary import Behavior, Distro
from cellc.robot.description.model import Box
from tests.catalog.chains import Matrix, transform
from tests.cells import catalog_facts, device_of, there
from tests.foreign_yaml import safe_load
from tests.oracles import here
from tests.vendors.oracle import RELEASES, Release, facts

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


def _craig(a: float, alpha: float, d: float, theta: float) -> Matrix:
    # Craig, Introduction to Robotics, eq. 3.6: screw along x, then along z.
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array(
        [[ct, -st, 0, a], [st * ca, ct * ca, -sa, -sa * d], [st * sa, ct * sa, ca, ca * d], [0, 0, 0, 1]], dtype=float
    )


def test_forward_kinematics_is_that_of_the_published_parameters() -> None:
    description = device_of("franka_fr3").description
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
    device = device_of("franka_fr3")
    home = {name: position.si for name, position in there(device.model.home).items()}
    np.testing.assert_allclose([home[name] for name in JOINTS], [0, -PI / 4, 0, -3 * PI / 4, 0, PI / 2, PI / 4])
    flange = transform(device.description, "fr3_link0", "fr3_link8", home)
    np.testing.assert_allclose(flange[:3, 2], [0, 0, -1], atol=1e-12)


def test_limits_are_the_documented_ones() -> None:
    device = device_of("franka_fr3")
    for index, name in enumerate(JOINTS):
        joint = there(device.description.joint(name))
        limit = there(joint.limit)
        assert (limit.lower, limit.upper) == (LOWER[index], UPPER[index])
        assert (limit.velocity, limit.effort) == (VELOCITY[index], TORQUE[index])
        acceleration, jerk = there(device.model.limits.acceleration_of(name)), there(device.model.limits.jerk_of(name))
        assert (acceleration.value.si, jerk.value.si) == (10.0, 5000.0)


@pytest.mark.parametrize(("joint", "sign"), [("fr3_joint4", -1), ("fr3_joint6", 1)])
def test_zero_is_out_of_the_range_of_two_joints(joint: str, sign: int) -> None:
    found = there(device_of("franka_fr3").description.joint(joint))
    assert found.limit is not None
    assert sign * there(found.limit.lower) > 0
    assert sign * there(found.limit.upper) > 0


def test_links_weigh_what_is_published() -> None:
    for index, mass in enumerate(MASSES):
        link = there(device_of("franka_fr3").description.link(f"fr3_link{index}"))
        assert there(link.inertial).mass == pytest.approx(mass, abs=5e-6)  # published with five figures there


def test_trajectories_on_the_robot_are_torques_with_the_shipped_gains() -> None:
    control = there(device_of("franka_fr3").model.control)
    commands = there(control.hardware.real).commands[Behavior.JOINT_TRAJECTORY]
    assert commands.interfaces == ("effort",)
    assert commands.parameters == {
        f"gains.{{prefix}}{joint}.{gain}": float(values[index])
        for gain, values in GAINS.items()
        for index, joint in enumerate(JOINTS)
    }


def test_hand_weighs_and_opens_as_published() -> None:
    hand = device_of("franka_hand")
    masses = [link.inertial.mass for link in hand.description.links if link.inertial is not None]
    assert sorted(masses) == [0.0291, 0.0291, 0.6544]
    np.testing.assert_allclose(transform(hand.description, "fr3_hand", "fr3_hand_tcp", {})[:3, 3], [0, 0, 0.1034])


@pytest.mark.parametrize(("finger", "gap_mm"), [(0.0, 0.2), (0.02, 40.2), (0.04, 80.2)])
def test_jaws_part_by_twice_the_way_of_a_finger(finger: float, gap_mm: float) -> None:
    # 2 q, and 0.1 mm by which each pad stands back from the middle.
    hand = device_of("franka_hand").description
    follower = there(hand.joint("fr3_finger_joint2"))
    assert follower.mimic is not None
    assert follower.mimic.joint == "fr3_finger_joint1"
    positions = {"fr3_finger_joint1": finger, "fr3_finger_joint2": finger * follower.mimic.multiplier}
    inner = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        link = there(hand.link(f"fr3_{side}finger"))
        frame = transform(hand, "fr3_hand", link.name, positions)
        boxes = [(shape.pose.position[1], shape.geometry) for shape in link.collisions]
        sizes = [(center, box.size[1]) for center, box in boxes if isinstance(box, Box)]
        assert len(sizes) == len(boxes)
        # The right finger is turned by half a turn: its y points to the other side.
        inner.append(sign * min(sign * (frame[1, 3] + frame[1, 1] * center) - width / 2 for center, width in sizes))
    assert (inner[0] - inner[1]) * 1000 == pytest.approx(gap_mm, abs=1e-6)


def test_real_hand_is_moved_by_a_node_and_by_no_component() -> None:
    control = there(device_of("franka_hand").model.control)
    assert control.hardware.real is None
    assert [node.executable for node in device_of("franka_hand").model.nodes] == ["franka_gripper_node"]


def _first_spec(model: str) -> str:
    return starter_spec("first", Distro.JAZZY, {"arm": NamedDevice(model, device_of(model))}, "cell.schema.json")


def test_first_spec_of_the_arm_commands_what_a_mock_can_follow() -> None:
    text = starter_spec(
        "first", Distro.JAZZY, {"arm": NamedDevice("franka_fr3", device_of("franka_fr3"))}, "cell.schema.json"
    )
    assert "type: joint_trajectory\n" in text
    assert "update_rate: 1000 Hz\n" in text
    assert "arm_group: 0 -45 0 -135 0 90 45 deg\n" in text


def test_first_spec_of_an_arm_with_fingers_has_a_controller_for_each_and_goes_aside() -> None:
    text = starter_spec(
        "first",
        Distro.JAZZY,
        {"arm": NamedDevice("kinova_gen3_2f_85", device_of("kinova_gen3_2f_85"))},
        "cell.schema.json",
    )
    assert "    arm_trajectory:\n" in text
    assert "    arm_action: {type: parallel_gripper, device: arm}\n" in text
    assert "    aside:\n      arm_group: 20 14.8969 179.909 -130.061 0 55.0039 89.9544 deg\n" in text
    assert "{move: home}, {move: aside}, {grip: close}, {grip: open}, {move: home}" in text


TABLE = Path(__file__).with_name("universal_robots.yaml")
PUBLISHED: dict[str, dict[str, Any]] = safe_load(TABLE.read_text(encoding="utf-8"))
MODELS = sorted(PUBLISHED)
POSITIONS = np.array([0.3, -1.1, 1.4, -0.7, 0.9, -0.4])
# facts/robots.md, section 1: the driver's order.
SIX_JOINTS = [f"{name}_joint" for name in ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")]


@cache
def _robot(model: str) -> Any:
    compiled = there(compiled_device(model))
    return pinocchio.buildModelFromXML(compiled[1])


def _configuration(model: str) -> Any:
    """Return the joints' positions as pinocchio has them: a continuous joint is a cosine and a sine."""
    last = POSITIONS[5]
    return POSITIONS if _robot(model).nq == 6 else np.array([*POSITIONS[:5], np.cos(last), np.sin(last)])


def test_the_table_has_every_model_of_the_family() -> None:
    assert [name for name in device_names() if device_of(name).model.family == "ur"] == MODELS


@pytest.mark.parametrize("model", MODELS)
def test_tool_is_where_the_vendors_description_has_it(model: str) -> None:
    robot = _robot(model)
    data = robot.createData()
    pinocchio.framesForwardKinematics(robot, data, _configuration(model))
    base, tool = (data.oMf[robot.getFrameId(frame)] for frame in ("base_link", "tool0"))
    actual = base.actInv(tool)
    x, y, z, *quaternion = PUBLISHED[model]["tool0"]
    np.testing.assert_allclose(actual.translation, [x, y, z], atol=1e-6)
    np.testing.assert_allclose(actual.rotation, pinocchio.Quaternion(np.array(quaternion)).matrix(), atol=1e-6)


@pytest.mark.parametrize("model", MODELS)
def test_links_weigh_what_the_vendor_publishes(model: str) -> None:
    robot, configuration = _robot(model), _configuration(model)
    data = robot.createData()
    np.testing.assert_allclose(
        np.diag(pinocchio.crba(robot, data, configuration)), PUBLISHED[model]["inertia"], rtol=1e-6
    )
    held = pinocchio.computeGeneralizedGravity(robot, data, configuration)
    np.testing.assert_allclose(held, PUBLISHED[model]["gravity"], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("model", MODELS)
def test_stretched_arm_reaches_as_far_as_the_data_sheet_says(model: str) -> None:
    # The vendor counts from the axis of the base to that of the last joint: at most with wrist 1 turned in line.
    _, upper, fore, _, fifth, _ = (abs(float(part)) for part in _arguments(model)["dh"].split())
    assert upper + fore < PUBLISHED[model]["reach"] <= upper + fore + fifth + 1e-9
    assert f"{PUBLISHED[model]['reach'] * 1000:g} mm reach" in device_of(model).model.summary


def _arguments(model: str) -> dict[str, str]:
    arguments: dict[str, str] = catalog_facts(model)["description"]["arguments"]
    return arguments


@pytest.mark.parametrize("model", MODELS)
def test_joints_are_those_of_the_driver_in_its_order(model: str) -> None:
    joints = [joint for joint in device_of(model).description.joints if joint.movable]
    assert [joint.name for joint in joints] == SIX_JOINTS
    # Only the small one turns its last joint without end: joint_limits.yaml, has_position_limits false.
    assert [joint.type for joint in joints] == ["revolute"] * 5 + ["continuous" if model == "ur3e" else "revolute"]
    assert all(joint.limit is not None and joint.limit.velocity and joint.limit.effort for joint in joints)


@pytest.mark.parametrize("release", here([release for release in RELEASES if release.device == "ur5e"]), ids=str)
def test_each_release_of_the_driver_knows_each_model(release: Release) -> None:
    launch = facts(release, "launch_arguments")["ur_robot_driver/launch/ur_control.launch.py"]
    assert set(MODELS) <= set(launch["ur_type"]["choices"])


@pytest.mark.parametrize("model", MODELS)
def test_real_plugin_is_told_its_own_model(model: str) -> None:
    control = there(device_of(model).model.control)
    told = [release.parameters.get("ur_type", model) for release in there(control.hardware.real).releases]
    assert set(told) == {model}


POSES: dict[str, Any] = safe_load(Path(__file__).with_name("published_poses.yaml").read_text(encoding="utf-8"))
SAME_ARM = {"kinova_gen3_2f_85": "kinova_gen3", "kinova_gen3_6dof_2f_85": "kinova_gen3_6dof"}
"""Models that are another one with fingers."""
ARMS = {name: name for name in POSES} | SAME_ARM
# By hand from the origins in the vendor's description: shoulder to flange, stretched out, m.
GEN3_UPPER_M = 2 * 0.21038 + 0.20843
WRIST_M = 2 * 0.10593 + 0.061525
OPENARM_M = 0.06625 + 0.15375 + 0.0955 + 0.1205
REACH_M = {
    "kinova_gen3": GEN3_UPPER_M + WRIST_M,
    "kinova_gen3_6dof": 0.41 + 0.20843 + WRIST_M,
    "openarm_v2_left": OPENARM_M,
    "openarm_v2_right": OPENARM_M,
}


@pytest.mark.parametrize("name", ARMS)
def test_the_tip_is_where_the_vendor_s_description_has_it(name: str) -> None:
    told, description = POSES[ARMS[name]], device_of(name).description
    for pose in told["poses"]:
        positions = dict(zip(told["joints"], pose["at"], strict=True))
        actual = transform(description, told["root"], told["tip"], positions)
        np.testing.assert_allclose(actual[:3], pose["tip"], atol=1e-6)


@pytest.mark.parametrize("name", ARMS)
def test_joints_stand_in_the_order_of_the_driver(name: str) -> None:
    told, device = POSES[ARMS[name]], device_of(name)
    fingers = device.model.gripper
    own = [joint.name for joint in device.description.joints if joint.movable and joint.mimic is None]
    assert own == [*told["joints"], *([] if fingers is None else [fingers.joint])]
    assert set(there(device.model.home)) == set(own)


@pytest.mark.parametrize("name", REACH_M)
def test_the_arm_reaches_as_far_as_its_links_are_long(name: str) -> None:
    told, description = POSES[name], device_of(name).description
    shoulder = transform(description, told["root"], description.joints[1].child, {})[:3, 3]
    generator, farthest = np.random.default_rng(3), 0.0
    for configuration in generator.uniform(-2.0, 2.0, size=(200, len(told["joints"]))):
        positions = dict(zip(told["joints"], configuration, strict=True))
        tip = transform(description, told["root"], told["tip"], positions)[:3, 3]
        farthest = max(farthest, float(np.linalg.norm(tip - shoulder)))
    assert 0.85 * REACH_M[name] < farthest <= REACH_M[name] + 0.03  # offsets of some millimetres beside the axis
