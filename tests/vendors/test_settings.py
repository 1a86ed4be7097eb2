"""What a real target is told beside plugins and nodes: the manager, tolerances, the camera, what it is built from."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cells import DISTROS, diagnose, spec_text, written
from tests.emit.cells import artifacts_of, emitted
from tests.foreign_yaml import safe_load
from tests.oracles import here
from tests.vendors.oracle import facts
from tests.vendors.packages import CASES, Case, real_target

of_the_arm = pytest.mark.parametrize(
    "case", here(case for case in CASES if case.release.device == "ur5e" and case.cell == "ur5e_pick"), ids=str
)


@of_the_arm
def test_the_manager_is_told_of_command_limits_what_the_vendor_tells_it(case: Case) -> None:
    told = facts(case.release, "controllers")["controller_manager"].get("enforce_command_limits")
    manager = real_target(case).yaml("config/controllers.yaml")["controller_manager"]["ros__parameters"]
    assert manager.get("enforce_command_limits") == (told if isinstance(told, bool) else None)


@of_the_arm
def test_joints_count_as_stopped_where_the_vendor_says_so(case: Case) -> None:
    listed = facts(case.release, "controllers")["controllers"]
    default = facts(case.release, "controllers")["initial_joint_controller_default"]
    told = listed[default]["parameters"]["constraints"]["stopped_velocity_tolerance"]
    sections = real_target(case).yaml("config/controllers.yaml")
    assert sections["arm_trajectory"]["ros__parameters"]["constraints"]["stopped_velocity_tolerance"] == told


@of_the_arm
def test_the_speed_scaling_of_the_arm_is_followed_by_a_controller_that_is_not_deprecated(case: Case) -> None:
    # 4.8.0 deprecates the vendor's own type, 6.0.0 has it no more: differences.md, scaled_joint_trajectory_controller.
    sections = real_target(case).yaml("config/controllers.yaml")
    type_ = sections["controller_manager"]["ros__parameters"]["arm_trajectory"]["type"]
    parameters = sections["arm_trajectory"]["ros__parameters"]
    scaling = "arm_speed_scaling/speed_scaling_factor"
    if case.release.distro in ("humble", "jazzy"):
        assert (type_, parameters["speed_scaling_interface_name"]) == (
            "ur_controllers/ScaledJointTrajectoryController",
            scaling,
        )
    else:
        assert type_ == "joint_trajectory_controller/JointTrajectoryController"
        assert parameters["speed_scaling"]["state_interface"] == scaling


@pytest.mark.parametrize("case", here([case for case in CASES if case.release.device == "franka_fr3"]), ids=str)
def test_trajectories_on_the_robot_claim_and_weigh_what_the_vendor_s_do(case: Case) -> None:
    told = facts(case.release, "controllers")["vendor_moveit"]["active"]["fr3_arm_controller"]
    parameters = real_target(case).yaml("config/controllers.real.yaml")["arm_trajectory"]["ros__parameters"]
    assert parameters["command_interfaces"] == told["command_interfaces"] == ["effort"]
    assert parameters["gains"] == {
        joint: {gain: value for gain, value in gains.items() if gain != "i_clamp"}  # i is 0: nothing to clamp
        for joint, gains in told["gains"].items()
    }
    assert real_target(case).yaml("config/controllers.mock.yaml")["arm_trajectory"]["ros__parameters"][
        "command_interfaces"
    ] == ["position"]


def test_the_camera_is_told_the_exposure_and_the_serial_that_the_spec_states(tmp_path: Path) -> None:
    # realsense2_camera: a serial of digits alone becomes an integer and fails; the node cuts the underscore off.
    model = "    model: realsense_d435i\n"
    text = spec_text("ur5e_pick").replace(model, f'{model}    serial: "123456"\n')
    given = safe_load(emitted(tmp_path, text)["config/drivers.yaml"])["camera"]["ros__parameters"]
    assert given["serial_no"] == "_123456"
    assert given["rgb_camera"]["enable_auto_exposure"] is given["depth_module"]["enable_auto_exposure"] is False
    assert (given["rgb_camera"]["exposure"], given["depth_module"]["exposure"]) == (80, 8000)  # 8 ms
    untold = safe_load(artifacts_of("ur5e_pick")["config/drivers.yaml"])["camera"]["ros__parameters"]
    assert "serial_no" not in untold


def test_what_no_distribution_releases_is_built_from_the_commit_that_is_pinned() -> None:
    sources = safe_load(artifacts_of("ur5e_pick")["sources.repos"])["repositories"]
    assert sources["ros2_robotiq_gripper"]["version"] == "3b6cf8ff9106384e72c23de7d3ba989fb6b41141"
    franka = safe_load(artifacts_of("fr3_hand")["sources.repos"])["repositories"]
    assert franka["franka_ros2"]["version"] == "43357d15b834c08b215df755b16989c972cb4204"
    assert franka["franka_description"]["version"] == "2.8.0"


def test_packages_are_wanted_at_the_pinned_number_at_least() -> None:
    package = ElementTree.fromstring(artifacts_of("ur5e_pick")["package.xml"])
    least = {exec_depend.text: exec_depend.get("version_gte") for exec_depend in package.iter("exec_depend")}
    assert least["ur_robot_driver"] == "3.8.0"
    assert least["controller_manager"] == "4.47.0"
    assert least["moveit_ros_move_group"] == "2.12.4"
    assert least["robotiq_driver"] is None  # a commit is no number


@pytest.mark.parametrize("distro", DISTROS)
def test_the_number_that_never_moved_pins_nothing(distro: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("ros: jazzy", f"ros: {distro}")
    text = text.replace("robotiq_driver 3b6cf8f", "robotiq_driver 0.0.1")
    audit = emitted(tmp_path, text)["audit.md"]
    (row,) = (line for line in audit.splitlines() if "| robotiq_driver 0.0.1 |" in line)
    assert "| UNKNOWN |" in row
    assert "pin a commit" in row


def test_a_pin_that_the_distribution_does_not_release_is_not_called_good() -> None:
    audit = artifacts_of("fr3_hand")["audit.md"]
    (row,) = (line for line in audit.splitlines() if line.startswith("| arm | driver | franka_ros2 2.5.0 |"))
    assert "| UNKNOWN |" in row
    assert "43357d15b834" in row


def test_a_commit_that_nobody_read_is_in_no_matrix(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("robotiq_driver 3b6cf8f", "robotiq_driver 0123abc")
    codes = {(found.code, found.yaml_path) for found in diagnose(written(tmp_path, text))}
    assert ("version-not-in-matrix", ("devices", "gripper", "driver")) in codes


def test_a_dashboard_that_would_end_at_once_is_not_started(tmp_path: Path) -> None:
    # dashboard_client_ros.cpp: PolyScope X below 10.11 has no Robot API; the process ends with exit(1).
    def started(firmware: str) -> bool:
        text = spec_text("ur5e_pick").replace("polyscope 5.21.0", firmware)
        launch = ElementTree.fromstring(emitted(tmp_path, text)["launch/cell.launch.xml"])
        return any(node.get("exec") == "dashboard_client" for node in launch.iter("node"))

    assert started("polyscope 5.21.0")
    assert started("polyscope_x 10.11.0")
    assert not started("polyscope_x 10.7.0")
