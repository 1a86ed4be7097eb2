"""The command line tools of ROS against `cellc mock --ros`: a person sees and drives what is played as a real cell."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from tests.cells import ROOT

for _name in ("rclpy", "sensor_msgs", "control_msgs", "moveit_msgs", "controller_manager_msgs", "tf2_msgs"):
    pytest.importorskip(_name)
for _name in ("ros2action", "ros2controlcli", "ros2lifecycle", "ros2node", "ros2param", "ros2service", "ros2topic"):
    pytest.importorskip(_name, reason=f"the command line tools of ROS are not installed: no {_name}")
_ROS2 = shutil.which("ros2") or ""
if not _ROS2:
    pytest.skip("`ros2` is not on the path", allow_module_level=True)

_DOMAIN = {"gw0": "88", "gw1": "87", "gw2": "86", "gw3": "85"}.get(os.environ.get("PYTEST_XDIST_WORKER", ""), "89")
_GRAPH = {**os.environ, "ROS_DOMAIN_ID": _DOMAIN, "ROS_LOCALHOST_ONLY": "1"}
_WITHIN_S = 180.0
_BY_HAND = "\nrehearsals:\n  by_hand: {steps: [wait: 600 s]}\n"
_KNUCKLE = "gripper_robotiq_85_left_knuckle_joint"
_ARM = [f"arm_{joint}_joint" for joint in ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")]
_GRIP, _MOVE = "/gripper_action/gripper_cmd", "/arm_trajectory/follow_joint_trajectory"


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The cell around a task that sends no goal, until the test ends it."""
    distro, out = os.environ["ROS_DISTRO"], tmp_path_factory.mktemp("by_hand")
    text = (ROOT / "cells/ur5e_pick/cell.yaml").read_text()
    assert text.count("\nrehearsals:") == 1
    head, _, tail = text.partition("\nrehearsals:")
    (out / "cell.yaml").write_text(head + _BY_HAND + tail.partition("\n")[2])
    build = [
        sys.executable,
        "-m",
        "cellc",
        "build",
        str(out / "cell.yaml"),
        "--matrix",
        f"ros={distro}",
        "-o",
        str(out),
    ]
    subprocess.run(build, check=True, capture_output=True)
    folder, node = out / f"ros-{distro}" / "ur5e_pick", f"{sys.executable} {ROOT / 'tests/consumers/ros_idle.py'}"
    asked = ["--ros", "--without", "task", "--ros-python", sys.executable, "--domain", _DOMAIN, "--launch", node]
    command = [sys.executable, "-m", "cellc", "mock", str(folder), *asked, "--rehearsal", "by_hand", "--pace", "0.5"]
    playing = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        until_s = time.monotonic() + _WITHIN_S
        while _MOVE not in ros2("action", "list") and playing.poll() is None and time.monotonic() < until_s:
            time.sleep(0.2)
        yield
    finally:
        playing.terminate()
        playing.wait()
        ros2("daemon", "stop")


def ros2(*words: str) -> str:
    """Return what a command prints."""
    ended = subprocess.run([_ROS2, *words], env=_GRAPH, capture_output=True, text=True, timeout=_WITHIN_S, check=False)
    return ended.stdout + ended.stderr


def test_nodes_and_actions_are_listed_with_their_types(cell: None) -> None:
    nodes = set(ros2("node", "list").split())
    assert {
        "/arm_trajectory",
        "/controller_manager",
        "/gripper_action",
        "/move_group",
        "/robot_state_publisher",
    } <= nodes
    assert "/task" in nodes
    assert set(ros2("action", "list", "-t").splitlines()) == {
        f"{_MOVE} [control_msgs/action/FollowJointTrajectory]",
        f"{_GRIP} [control_msgs/action/ParallelGripperCommand]",
        "/move_action [moveit_msgs/action/MoveGroup]",
    }


def test_topics_are_as_those_of_the_cell(cell: None) -> None:
    topics = set(ros2("topic", "list", "-t").splitlines())
    assert "/joint_states [sensor_msgs/msg/JointState]" in topics
    assert "/camera/color/image_raw [sensor_msgs/msg/Image]" in topics
    states = ros2("topic", "echo", "--once", "/joint_states")
    assert all(f"- {joint}\n" in states for joint in (*_ARM, _KNUCKLE))
    seen = ros2("topic", "info", "-v", "/joint_states")
    published, _, heard = seen.partition("Subscription count:")
    assert "Node name: joint_states\n" in published
    assert "Node name: task\n" in heard
    assert ("Reliability: RELIABLE" in published, "Durability: TRANSIENT_LOCAL" in published) == (True, True)


def test_what_rviz_needs_reaches_it_late(cell: None) -> None:
    """RViz subscribes to the description and to fixed transforms as transient local: they were sent before it came."""
    described = ros2("topic", "echo", "--once", "--full-length", "--field", "data", "/robot_description")
    assert "<robot " in described
    latched = ("--qos-durability", "transient_local", "--qos-reliability", "reliable")
    fixed = ros2("topic", "echo", "--once", "--full-length", *latched, "/tf_static")
    assert "child_frame_id: camera_color_optical_frame" in fixed
    assert "child_frame_id: arm_wrist_3_link" in ros2("topic", "echo", "--once", "--full-length", "/tf")


def test_parameters_are_those_of_the_folder(cell: None) -> None:
    described = ros2("param", "get", "--hide-type", "/robot_state_publisher", "robot_description")
    assert described.startswith("<?xml")
    assert f'<joint name="{_KNUCKLE}"' in described
    assert ros2("param", "get", "/controller_manager", "update_rate") == "Integer value is: 500\n"
    assert all(joint in ros2("param", "get", "/arm_trajectory", "joints") for joint in _ARM)


def test_a_played_lifecycle_node_has_its_state(cell: None) -> None:
    assert ros2("lifecycle", "nodes") == "/perception\n"
    assert ros2("lifecycle", "get", "/perception") == "active [3]\n"


def test_goals_are_executed(cell: None) -> None:
    goal = f"{{command: {{name: [{_KNUCKLE}], position: [0.4]}}}}"
    gripped = ros2("action", "send_goal", _GRIP, "control_msgs/action/ParallelGripperCommand", goal)
    assert "reached_goal: true" in gripped
    assert gripped.endswith("Goal finished with status: SUCCEEDED\n")
    moved = ros2("action", "send_goal", "-f", _MOVE, "control_msgs/action/FollowJointTrajectory", _trajectory(2))
    assert "Feedback:" in moved
    assert "error_string: Goal successfully reached!" in moved
    assert moved.endswith("Goal finished with status: SUCCEEDED\n")
    refused = ros2("action", "send_goal", _MOVE, "control_msgs/action/FollowJointTrajectory", "{}")
    assert "Goal was rejected." in refused


def test_a_goal_is_canceled_by_its_service(cell: None) -> None:
    words = [_ROS2, "action", "send_goal", _MOVE, "control_msgs/action/FollowJointTrajectory", _trajectory(600)]
    child = subprocess.Popen(words, env=_GRAPH, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1)
    assert child.stdout is not None
    assert any(line.startswith("Goal accepted") for line in child.stdout)
    canceled = ros2("service", "call", f"{_MOVE}/_action/cancel_goal", "action_msgs/srv/CancelGoal")
    assert "goals_canceling=[action_msgs.msg.GoalInfo(" in canceled
    assert child.communicate(timeout=_WITHIN_S)[0].endswith("Goal finished with status: CANCELED\n")


def test_the_controller_manager_is_asked_by_ros2_control(cell: None) -> None:
    listed = [line.split() for line in ros2("control", "list_controllers").splitlines()]
    assert ["arm_trajectory", "joint_trajectory_controller/JointTrajectoryController", "active"] in listed
    components = ros2("control", "list_hardware_components")
    assert "name: arm_hardware\n" in components
    assert "arm_elbow_joint/position [available] [claimed]" in components
    assert "\tarm_elbow_joint/position [available] [claimed]\n" in ros2("control", "list_hardware_interfaces")
    types = [line.split() for line in ros2("control", "list_controller_types").splitlines()]
    named = "joint_trajectory_controller/JointTrajectoryController"
    assert [named, "controller_interface::ControllerInterface"] in types
    switched = ros2("control", "switch_controllers", "--strict", "--deactivate", "arm_speed")
    assert "Successfully switched controllers" in switched
    service = "/controller_manager/list_controllers"
    called = ros2("service", "call", service, "controller_manager_msgs/srv/ListControllers")
    assert "name='arm_speed', state='inactive'" in called


def _trajectory(seconds: int) -> str:
    joints, at = ", ".join(_ARM), "[0.0, -1.57, 1.57, -1.57, -1.57, 0.0]"
    point = f"{{positions: {at}, time_from_start: {{sec: {seconds}}}}}"
    return f"{{trajectory: {{joint_names: [{joints}], points: [{point}]}}}}"
