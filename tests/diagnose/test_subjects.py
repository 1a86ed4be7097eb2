"""What observations speak of, for the complete cell: each row by hand from its spec."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FrameKind
from cellc.tools.diagnose.fields import FIELDS, Scope
from cellc.tools.diagnose.subjects import subjects
from tests.cells import COMPLETE, linked

_JOINTS = ", ".join(f"arm_joint_{number}" for number in range(1, 7))
_CLAIMS = ", ".join(f"arm_joint_{number}/position" for number in range(1, 7))
_PLUGIN = "demo_arm_controllers/ScaledTrajectory"
_TRAJECTORY = ("arm_trajectory", "/arm_trajectory", "/controller_manager", _PLUGIN, _JOINTS, _CLAIMS, "0.2")
_UNSTATED = "not stated"
_ARM = ("arm", "192.168.56.101", _UNSTATED, _UNSTATED, "controller 5.21.0", "demo_arm_driver 3.8.0")
_LOADED = (*_ARM, "1.0 kg, center of mass 0 0 58 mm")
_GRIPPER = ("gripper", "/dev/ttyUSB0", _UNSTATED, _UNSTATED, "fingers 1.2.0", "demo_gripper_driver 0.0.1", _UNSTATED)
_CAMERA = ("camera", _UNSTATED, _UNSTATED, _UNSTATED, "sensor 5.16.0", "demo_camera_driver 4.58.3", _UNSTATED)
_IMAGE = ("/camera/camera/color/image_raw", "camera_color_optical", "30 Hz")
ROWS: dict[Scope, list[tuple[str, ...]]] = {
    # Of all frames the object alone moves by a publisher of its own: what has no other is the state publisher's.
    "cell": [
        (
            "demo",
            "42",
            "rmw_fastrtps_cpp",
            "localhost",
            "robot_state_publisher, perception",
            "safety_plc",
            "operator",
        )
    ],
    "host": [("control_pc", "preempt_rt", "robot 192.168.56.10/24, bulk 10.10.0.10/24", "0.001 s")],
    "action": [
        ("/move_action", "move_group", "task"),
        ("/arm_trajectory/follow_joint_trajectory", "arm_trajectory", "move_group"),
        ("/gripper_action/gripper_cmd", "gripper_action", "task"),
    ],
    "trajectory": [_TRAJECTORY],
    "manager": [("/controller_manager", "", "500", "arm_hardware, gripper_hardware")],
    "group": [("manipulator", _JOINTS, "tcp")],
    "frame": [
        ("arm_base_link", "world", "robot_state_publisher", "none"),
        ("gripper_base", "arm_tool0", "robot_state_publisher", "none"),
        ("camera_link", "arm_tool0", "robot_state_publisher", "hand_eye"),
        ("tcp", "gripper_base", "robot_state_publisher", "tcp"),
        ("fixture_A", "world", "robot_state_publisher", "fixture_a"),
        ("object", "camera_color_optical", "perception", "none"),
    ],
    "lifecycle_node": [("/perception",)],
    "device": [_LOADED, _GRIPPER, _CAMERA],
    "arm": [_LOADED],
    "gripper": [_GRIPPER],
    "camera": [(*_IMAGE, *_CAMERA)],
}


@cache
def _cell() -> Cell:
    return linked(COMPLETE)


def _rows(cell: Cell, scope: Scope) -> list[tuple[str, ...]]:
    return [tuple(subject.values()) for subject in subjects(cell, scope)]


@pytest.mark.parametrize("scope", ROWS)
def test_rows_of_a_scope_are_those_of_the_spec(scope: Scope) -> None:
    assert _rows(_cell(), scope) == ROWS[scope]
    assert [tuple(subject) for subject in subjects(_cell(), scope)] == [FIELDS[scope]] * len(ROWS[scope])


def test_topic_names_both_ends_with_their_qos_and_its_figures() -> None:
    rows = {row[0]: row[1:] for row in _rows(_cell(), "topic")}
    camera, sink = "from camera reliable, volatile, last 10", "to perception best_effort, volatile, last 1"
    assert rows["/camera/camera/color/image_raw"] == (
        "sensor_msgs/msg/Image",
        "camera",
        f"{camera}; {sink}",
        "30 Hz",
        "0.1 s",
    )
    assert rows["/tf"][3:] == (_UNSTATED, _UNSTATED)
    assert "/move_action" not in rows


def test_controllers_are_those_that_drive_joints_and_nodes_are_all() -> None:
    assert [row[0] for row in _rows(_cell(), "controller")] == ["arm_trajectory", "gripper_action"]
    nodes = ["/perception", "/task", "/move_group", "/robot_state_publisher", "/controller_manager"]
    assert [row[0] for row in _rows(_cell(), "node")] == nodes


def test_no_moving_frame_leaves_the_state_publisher_alone() -> None:
    cell = _cell()
    still = replace(cell, frames=tuple(frame for frame in cell.frames if frame.kind is not FrameKind.DYNAMIC))
    assert _rows(still, "cell")[0][4] == "robot_state_publisher"
