"""First looks: what the parts and words of a text point to, what its numbers and names are."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.tools.diagnose.codes import codes, codes_in
from cellc.tools.diagnose.looks import first_looks, kinds_of, looks
from cellc.tools.diagnose.named import named_in, names
from tests.cells import ROOT, linked
from tests.cli.run import run

CELL = ROOT / "cells/ur5e_pick/cell.yaml"

# A sentence of our own → a piece of the cause that is the first or the second look.
POINTED = {
    "the modbus register shows 256 where the plc has 1, as if the bytes were swapped": "in the opposite order",
    "our weld gun's digital input is always true while nothing touches the sensor": "active low",
    "set filter.enable:=true in the launch, the parameter is ignored since": "not known to the installed version",
    "ros2 node list still shows old nodes": "the daemon of ros2",
    "pressing execute in rviz does nothing, planning is fine, and rqt_joint_trajectory_controller jogs": "no, or an",
    "rviz on the laptop: could not load mesh resource, the model is invisible": "mesh paths are absolute",
    "the canopen drive times out while it boots since the update": "a timeout of the configuration is shorter",
    "dynamixel 4 blinks red and its torque is off": "shut its torque off",
    "the gripper grasp is aborted immediately, my loop sends the goal in every cycle": "repeated command",
    "the camera works as root, else permission denied": "udev rules",
    "in gazebo the arm explodes and bounces violently": "links overlap",
    "octomap stays empty, move_group is not subscribed to the depth camera's point cloud": "the updater is not set up",
    "my rclpy node hangs in a callback that calls a service and waits for the future": "callback",
    "aruco pose is all zeros": "no intrinsics",
    "it worked until yesterday and nothing moves any more": "what changed since it worked",
}


@pytest.mark.parametrize("text", POINTED)
def test_words_of_a_text_point_to_its_cause(text: str) -> None:
    causes = [each.look.cause for each in first_looks(text)[:2]]
    assert any(POINTED[text] in cause for cause in causes), causes


def test_text_that_names_no_part_has_no_first_look_and_no_trouble_of_a_kind() -> None:
    assert first_looks("the weather is nice") == ()
    assert kinds_of("the weather is nice") == frozenset()


def test_whole_words_count_and_no_pieces_of_others() -> None:
    causes = [each.look.cause for each in first_looks("unexpected command while the robot model handles units")]
    assert not any("decimal comma" in cause for cause in causes)


def test_denied_errors_are_no_refusal() -> None:
    assert "refuses" not in kinds_of("there is no error")
    assert "refuses" in kinds_of("there is an error")


def test_at_most_three_of_four_looks_are_of_one_part_and_no_action_is_there_twice() -> None:
    for text in POINTED:
        chosen = first_looks(text)
        assert len(chosen) <= 4
        assert len({each.look.action for each in chosen}) == len(chosen)
        assert all(sum(1 for other in chosen if other.part == each.part) <= 3 for each in chosen)


def test_every_part_covers_several_kinds_of_trouble_and_has_public_sources() -> None:
    table = looks()
    assert len(table.parts) >= 25
    for part in table.parts:
        covered = {kind for look in part.looks for kind in look.kinds or table.kinds}
        assert covered <= set(table.kinds), part.part
        assert len(covered) >= 3, part.part
        assert re.search(r"https://|REP \d|\(\d\)|CiA|MODBUS|IgH", part.source), part.part


def test_no_pattern_finds_something_in_a_text_that_says_nothing() -> None:
    table = looks()
    patterns = [row for part in table.parts for row in part.says]
    patterns += [row for rows in table.kinds.values() for row in rows]
    patterns += [row for part in table.parts for look in part.looks for row in look.when]
    patterns += [row for look in table.general for row in look.when]
    patterns += [row for family in codes().families for row in (*family.of, family.number)]
    patterns += [each.says for each in names().names]
    assert [pattern for pattern in patterns if re.search(pattern, "zq zq")] == []


CODES = {
    "move_group returned error code: -4": "MoveItErrorCodes: CONTROL_FAILED",
    "FollowJointTrajectory result: error_code -5": "GOAL_TOLERANCE_VIOLATED",
    "[driver-1] process has died [pid 5, exit code -11, cmd a]": "SIGSEGV",
    "MotoROS2: alarm 8011[17]": "fatal error",
    "StartTrajMode_Response(result_code=motoros2_interfaces.msg.MotionReadyEnum(value=105))": "REMOTE",
    "ethercat slave 2, AL status 0x001B": "watchdog of a sync manager",
    "canopen: SDO abort 06090011": "no such subindex",
    "the canopen drive has error code 0x8611": "following error",
    "modbus exception code 2": "illegal data address",
    "FANUC says SRVO-230": "servo",
    "ABB event 50027": "motion",
    "robotiq gFLT 0x0E": "overcurrent",
    "dynamixel hardware error status 32": "overload",
    "xarm: ControllerError, error code 24": "speed exceeds",
}


@pytest.mark.parametrize("text", CODES)
def test_number_is_explained_by_the_interface_that_the_text_names(text: str) -> None:
    assert any(CODES[text] in line for line in codes_in(text)), codes_in(text)


@pytest.mark.parametrize("text", ["the value is -4", "it took 8011 s", "error code 24", "port 50027", "modbus 2"])
def test_number_of_no_named_interface_is_not_explained(text: str) -> None:
    assert codes_in(text) == ()


def test_every_code_is_one_that_its_pattern_can_find() -> None:
    for family in codes().families:
        assert len(family.meanings) == len(family.codes), family.family
        assert re.search(r"https://|CiA|MODBUS|ETG|signal|manual|Code List|Event", family.source), family.family


def test_names_are_those_of_the_contract_and_else_well_known() -> None:
    cell = linked(CELL)
    (topic, *_) = named_in("no data on /object_pose", cell)
    assert topic.startswith("`/object_pose`: topic geometry_msgs/msg/PoseStamped, from ")
    (other, *_) = named_in("I echo the topic /kinect/object_pose", cell)
    assert other == "`/kinect/object_pose`: the contract of this cell has no such name; `/object_pose` ends alike"
    assert named_in("the file /home/me/object_pose", cell) == ()
    (known,) = named_in("Missing virtual_joint", None)
    assert known.startswith("`virtual_joint`: joint of the SRDF")


def test_first_looks_are_before_what_is_only_like_the_words_and_not_where_a_line_names_the_cause() -> None:
    out = run("diagnose", "octomap is not refreshed after the obstacle is removed", CELL.as_posix()).out
    assert out.index("first looks, by the parts and words") < out.rindex("obstacles stay in the map of the camera")
    certain = run("diagnose", "nodes cannot see each other", CELL.as_posix()).out
    assert "first looks" not in certain


def test_log_that_says_a_failure_in_its_own_words_is_answered(tmp_path: Path) -> None:
    said = "Exception caught: 'Cartesian limits are not fully set for LIN trajectory generator.'"
    (tmp_path / "a.log").write_text(f"{said}\n", encoding="utf-8")
    ran = run("diagnose", "--log", tmp_path.as_posix(), CELL.as_posix())
    assert "no known symptom in" not in ran.out
    assert "robot_description_planning" in ran.out
    assert ran.code == 1
