"""Single values of the artifacts, against the facts of the devices and the cell's own words."""

from __future__ import annotations

import io
import math
from pathlib import Path
from xml.etree import ElementTree

import yourdfpy

from tests.cells import graph_of, spec_text, written
from tests.emit.cells import artifacts_of
from tests.foreign_yaml import safe_load


def test_joint_limits_are_those_of_the_cell() -> None:
    # facts: elbow pi, velocity pi rad/s, of which 50 %; 5 rad/s^2, of which 50 %.
    (section,) = safe_load(artifacts_of("ur5e_pick")["config/joint_limits.yaml"]).values()
    limits = section["ros__parameters"]["robot_description_planning"]["joint_limits"]
    assert limits["arm_elbow_joint"] == {
        "has_position_limits": True,
        "min_position": -math.pi,
        "max_position": math.pi,
        "has_velocity_limits": True,
        "max_velocity": math.pi / 2,
        "has_acceleration_limits": True,
        "max_acceleration": 2.5,
        "has_jerk_limits": True,
        "max_jerk": 50.0,
    }


def test_frame_tree_tells_parents_and_calibrations() -> None:
    frames = safe_load(artifacts_of("ur5e_pick")["config/frames.yaml"])["frames"]
    assert frames["tcp"]["parent"] == "gripper_base_link"
    assert frames["tcp"]["calibration"] == "tcp_2f"
    assert frames["tcp"]["xyz"] == [0.0, 0.0, 0.162]
    assert frames["object"] == {
        "parent": "camera_color_optical_frame",
        "kind": "dynamic",
        "authority": "perception",
        "rate_hz": 10.0,
        "buffer_s": 10.0,
    }
    assert [name for name, frame in frames.items() if "parent" not in frame] == ["world"]


def test_build_installs_every_folder_that_something_reads_at_run_time() -> None:
    artifacts = artifacts_of("ur5e_pick")
    installed = artifacts["CMakeLists.txt"].split()
    folders = {path.partition("/")[0] for path in artifacts if "/" in path}
    assert folders - {"graph", "gates", "scripts"} <= set(installed)
    assert "scripts/bring_up" in installed
    assert {"contract.json", "rehearsals.json", "manifest.json"} <= set(installed)


def test_mock_begins_at_full_speed_scaling() -> None:
    robot = ElementTree.fromstring(artifacts_of("ur5e_pick")["urdf/ur5e_pick.mock.urdf"])
    path = "ros2_control/gpio[@name='arm_speed_scaling']/state_interface[@name='speed_scaling_factor']/param"
    factor = robot.find(path)
    assert factor is not None
    assert factor.text == "1"


def test_every_body_and_follower_is_that_of_the_devices(tmp_path: Path) -> None:
    urdf = yourdfpy.URDF.load(io.BytesIO(artifacts_of("ur5e_pick")["urdf/ur5e_pick.real.urdf"].encode()))
    devices = graph_of(written(tmp_path, spec_text("ur5e_pick"))).cell.devices
    for link in (link for device in devices for link in device.body.description.links if link.inertial is not None):
        body, read = link.inertial, urdf.link_map[link.name].inertial
        assert body is not None
        assert read.mass == body.mass
        tensor = [body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz, body.izz]
        assert read.inertia.flatten().tolist() == tensor
    for joint in (joint for device in devices for joint in device.body.description.joints if joint.mimic is not None):
        mimic, read = joint.mimic, urdf.joint_map[joint.name].mimic
        assert mimic is not None
        assert (read.joint, read.multiplier, read.offset) == (mimic.joint, mimic.multiplier, mimic.offset)


def test_parameters_of_a_node_stand_under_its_name() -> None:
    texts = artifacts_of("ur5e_pick")
    assert list(safe_load(texts["config/drivers.yaml"])) == ["arm_dashboard_client", "arm_state_helper", "camera"]
    assert list(safe_load(texts["config/nodes.yaml"])) == ["perception", "task"]


def test_package_depends_on_what_it_starts_and_loads() -> None:
    package = ElementTree.fromstring(artifacts_of("ur5e_pick")["package.xml"])
    assert [entry.text for entry in package.findall("exec_depend")] == [
        "action_msgs",
        "builtin_interfaces",
        "cell_perception",
        "cell_tasks",
        "control_msgs",
        "controller_manager",
        "controller_manager_msgs",
        "diagnostic_msgs",
        "hardware_interface",
        "joint_state_broadcaster",
        "joint_trajectory_controller",
        "librealsense2",
        "liburdfdom-tools",
        "lifecycle_msgs",
        "moveit_kinematics",
        "moveit_planners_ompl",
        "moveit_ros_move_group",
        "moveit_simple_controller_manager",
        "mujoco_ros2_control",
        "mujoco_ros2_control_plugins",
        "pal_statistics_msgs",
        "parallel_gripper_controller",
        "pilz_industrial_motion_planner",
        "pose_broadcaster",
        "python3-yaml",
        "rcl_interfaces",
        "rclpy",
        "realsense2_camera",
        "realsense2_description",
        "rmw_fastrtps_cpp",
        "robot_state_publisher",
        "robotiq_description",
        "robotiq_driver",
        "ros2bag",
        "ros2cli_common_extensions",
        "ros2controlcli",
        "ros2launch",
        "rosbag2_storage_mcap",
        "sensor_msgs",
        "sros2",
        "std_msgs",
        "std_srvs",
        "tf2_msgs",
        "tf2_ros",
        "trajectory_msgs",
        "ur_calibration",
        "ur_client_library",
        "ur_controllers",
        "ur_dashboard_msgs",
        "ur_description",
        "ur_msgs",
        "ur_robot_driver",
        "xacro",
    ]
