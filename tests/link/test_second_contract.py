"""The cell with seven joints, effort interfaces and a gripper that a node moves: read, parsed, linked, described."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.formats.urdf.robot import robot_description
from cellc.compiler.pipeline import check
from tests.cells import linked, spec_of, spec_text, there, without_absent, written

SPEC = spec_of("fr3_hand")
JOINTS = tuple(f"fr3_joint{number}" for number in range(1, 8))
TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"


@pytest.fixture(scope="module")
def cell() -> Cell:
    return linked(SPEC)


def _controller(cell: Cell, name: str) -> Controller:
    return next(controller for controller in cell.controllers if controller.name == name)


def _changed(old: str, new: str, folder: Path) -> Cell:
    text = SPEC.read_text(encoding="utf-8")
    assert old in text
    return linked(written(folder, text.replace(old, new)))


def test_spec_is_a_page_of_120_lines_at_most() -> None:
    assert len(SPEC.read_text(encoding="utf-8").splitlines()) <= 120


def test_only_what_nobody_has_read_off_the_robot_blocks_the_real_target() -> None:
    found = check(str(SPEC)).diagnostics
    assert {(entry.code, entry.severity.value) for entry in found} == {
        ("assumed-in-simulation", "audit"),
        ("missing-rollback", "blocker"),
        ("unknown-version", "blocker"),
    }


def test_joints_have_the_names_of_the_vendor_where_the_prefix_is_empty(cell: Cell) -> None:
    assert tuple(joint.name for joint in cell.device("arm").joints) == JOINTS
    hand = cell.device("hand")
    assert [(joint.name, joint.mimics) for joint in hand.joints] == [
        ("fr3_finger_joint1", None),
        ("fr3_finger_joint2", "fr3_finger_joint1"),
    ]
    assert hand.mount.parent_frame == "fr3_link8"
    assert next(group for group in cell.groups if group.name == "arm").tip_frame == "fr3_hand_tcp"


def test_limits_of_the_cell_are_shares_of_the_documented_ones(cell: Cell) -> None:
    # 35 % of 2.62 and 5.26 rad/s stay below the rectangular limits of 1.0 (joint 2) and 3.0 rad/s (joint 5).
    by_name = {joint.name: joint for joint in cell.device("arm").joints}
    assert by_name["fr3_joint2"].velocity == pytest.approx(0.917)
    assert by_name["fr3_joint5"].velocity == pytest.approx(1.841)
    assert by_name["fr3_joint2"].acceleration == pytest.approx(1.5)
    assert by_name["fr3_joint2"].jerk == 5000.0


def test_alternate_that_claims_effort_by_name_has_the_gains_of_the_vendor(tmp_path: Path) -> None:
    # Cells of strangers switch to it, as the cell here did until its trajectories became torques on the robot.
    old = "    hand_action:"
    alternate = "{type: effort_joint_trajectory, device: arm, active: false, goal_time: 1 s, path_tolerance: 0.1 rad,"
    new = f"    arm_effort:\n      {alternate}\n       goal_tolerance: 0.01 rad, client: move_group}}\n{old}"
    controller = _controller(_changed(old, new, tmp_path), "arm_effort")
    assert controller.claims("real") == tuple(f"{joint}/effort" for joint in JOINTS)
    assert controller.parameters["gains.fr3_joint1.p"] == 600.0
    assert not [found for found in check(tmp_path / "cell.yaml").diagnostics if found.severity.value == "error"]


def test_arm_is_commanded_by_position_on_the_mock_and_by_effort_on_the_robot(cell: Cell) -> None:
    arm = _controller(cell, "arm_trajectory")
    assert arm.behavior == cell.behaviors[TRAJECTORY] == "joint_trajectory"
    assert arm.claims("mock") == tuple(f"{joint}/position" for joint in JOINTS)
    assert arm.claims("real") == tuple(f"{joint}/effort" for joint in JOINTS)
    assert arm.parameters_on("mock")["command_interfaces"] == ("position",)
    assert arm.parameters_on("real")["command_interfaces"] == ("effort",)
    assert not [name for name in arm.parameters_on("mock") if name.startswith("gains.")]
    assert arm.parameters_on("real")["gains.fr3_joint1.p"] == 600.0
    assert arm.parameters_on("real")["gains.fr3_joint7.d"] == 5.0


def test_parameter_names_carry_the_prefix(tmp_path: Path) -> None:
    prefixed = _changed('    prefix: ""                 # joints', "    prefix: left_  # joints", tmp_path)
    parameters = _controller(prefixed, "arm_trajectory").parameters_on("real")
    assert parameters["gains.left_fr3_joint4.p"] == 600.0
    assert not [name for name in parameters if "{" in name]
    arm = there(prefixed.device("arm").control.hardware)
    assert (arm.name, arm.parameters["real"]["prefix"]) == ("left_FrankaHardwareInterface", "left_")


def test_claims_of_the_spec_hold_on_every_target_and_come_before_those_of_the_vendor(tmp_path: Path) -> None:
    written = "{type: joint_trajectory, device: arm,"
    changed = _changed(written, f"{written} command_interfaces: [position, velocity],", tmp_path)
    arm = _controller(changed, "arm_trajectory")
    assert arm.claims("mock") == arm.claims("real")
    assert arm.parameters_on("real")["command_interfaces"] == ("position", "velocity")
    assert not [name for name in arm.parameters_on("real") if name.startswith("gains.")]


def test_node_of_the_hand_reaches_it_through_the_arm(cell: Cell) -> None:
    (node,) = (node for node in cell.nodes if node.device == "hand")
    assert node.real_only
    assert node.parameters == {"robot_ip": "172.16.0.2", "joint_names": ("fr3_finger_joint1", "fr3_finger_joint2")}


def test_address_of_the_carrier_is_unknown_where_the_arm_has_none(tmp_path: Path) -> None:
    changed = _changed("nic: robot, address: 172.16.0.2}", "nic: robot}", tmp_path)
    (node,) = (node for node in changed.nodes if node.device == "hand")
    assert node.parameters["robot_ip"] == "UNKNOWN"


def test_hand_has_hardware_on_the_mock_alone(cell: Cell) -> None:
    hand, driver = there(cell.device("hand").control.hardware), there(cell.device("hand").control.driver)
    assert hand.targets == tuple(hand.plugins) == ("mock",)
    assert (driver.node, driver.program) == ("/hand_gripper", "franka_gripper/franka_gripper_node")
    tags = {
        target: [tag.get("name") for tag in robot_description(cell, target).iter("ros2_control")]
        for target in ("mock", "real")
    }
    assert tags == {"mock": ["FrankaHardwareInterface", "hand_hardware"], "real": ["FrankaHardwareInterface"]}


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted", "lyrical"])
def test_cell_links_on_every_distribution(distro: str, tmp_path: Path) -> None:
    text = without_absent(SPEC.read_text(encoding="utf-8"), distro)
    changed = linked(written(tmp_path, text.replace("ros: humble", f"ros: {distro}")))
    assert _controller(changed, "arm_trajectory").plugin == TRAJECTORY


@pytest.mark.parametrize(
    ("distro", "behavior", "parameter"),
    [
        ("humble", "scaled_joint_trajectory", "speed_scaling_interface_name"),
        ("jazzy", "scaled_joint_trajectory", "speed_scaling_interface_name"),
        # The vendor's type is deprecated, then gone; upstream's has a parameter of its own (facts/robots.md).
        ("kilted", "joint_trajectory", "speed_scaling.state_interface"),
        ("lyrical", "joint_trajectory", "speed_scaling.state_interface"),
    ],
)
def test_controller_that_is_told_of_speed_scaling_follows_it(
    distro: str, behavior: str, parameter: str, tmp_path: Path
) -> None:
    text = spec_text("ur5e_pick")
    changed = linked(written(tmp_path, text.replace("ros: jazzy", f"ros: {distro}")))
    controller = _controller(changed, "arm_trajectory")
    assert controller.behavior == behavior
    assert controller.parameters[parameter] == "arm_speed_scaling/speed_scaling_factor"
