"""What tools of hand-eye calibration write, by their own sources, and where a camera of the corpus then stands.

The camera's optical frame is turned in its base as REP-103 says: z forward, x right, y down. Poses are by hand.
"""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.contract.diagnostics import Outcome
from tests.cells import linking, spec_text, there

MOUNT = "xyz: 0 -70 30 mm, rpy: 0 -75 -90 deg, calibration"
# From easy_handeye2 b42cae6: message_to_yaml of HandeyeCalibration.msg and HandeyeCalibrationParameters.msg.
EASY = """\
parameters:
  name: wrist
  calibration_type: {kind}
  robot_base_frame: arm_base_link
  robot_effector_frame: arm_tool0
  tracking_base_frame: camera_color_optical_frame
  tracking_marker_frame: marker
  freehand_robot_movement: true
  move_group_namespace: /
  move_group: manipulator
transform:
  translation:
    x: 0.0175
    y: -0.07
    z: 5.0e-02
  rotation:
    x: 0.0
    y: 0.0
    z: 0.0
    w: 1.0
"""
# The form of camera_pose.launch.py of MoveIt's calibration display for ROS 2.
LAUNCH = '''\
""" Static transform publisher acquired via MoveIt 2 hand-eye calibration """
""" EYE-IN-HAND: arm_tool0 -> camera_color_optical_frame """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    nodes = [
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            output="log",
            arguments=[
                "--frame-id",
                "arm_tool0",
                "--child-frame-id",
                "camera_color_optical_frame",
                "--x",
                "0.0175",
                "--y",
                "-0.07",
                "--z",
                "0.05",
                "--qx",
                "0",
                "--qy",
                "0",
                "--qz",
                "0",
                "--qw",
                "1",
                # "--roll",
                # "3.14159",
            ],
        ),
    ]
    return LaunchDescription(nodes)
'''
NAMES = '"parent": "arm_tool0", "child": "camera_color_optical_frame"'
MATRIX = f'{{{NAMES}, "matrix": [[1, 0, 0, 0.0175], [0, 1, 0, -0.07], [0, 0, 1, 0.05], [0, 0, 0, 1]]}}'
PLAIN = f'{{{NAMES}, "xyz": [0.0175, -0.07, 0.05], "wxyz": [1, 0, 0, 0]}}'
SWAPPED = '"parent": "camera_color_optical_frame", "child": "arm_tool0"'
BACKWARDS = f'{{{SWAPPED}, "xyz": [-0.0175, 0.07, -0.05], "xyzw": [0, 0, 0, 1]}}'


def cell(folder: Path, file: str, text: str, mount: str = "calibration", more: str = "") -> Outcome[Cell]:
    """Link the cell of a UR5e whose wrist camera rests on a file."""
    (folder / file).write_text(text, encoding="utf-8")
    spec = spec_text("ur5e_pick").replace("hand_eye: {revision", f"hand_eye: {{from: {file}, {more}revision")
    assert MOUNT in spec
    (folder / "cell.yaml").write_text(spec.replace(MOUNT, mount), encoding="utf-8")
    return linking(folder / "cell.yaml")


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("wrist.calib", EASY.format(kind="eye_in_hand")),
        ("camera_pose.launch.py", LAUNCH),
        ("matrix.json", MATRIX),
        ("wxyz.yaml", PLAIN),
        ("rounded.json", MATRIX.replace("[0, 0, 1, 0.05]", "[0, 0, 1.0009, 0.05]")),  # squared, 1.0018
        ("backwards.json", BACKWARDS),
    ],
    ids=["easy_handeye2", "moveit", "matrix", "quaternion", "rounded", "names the other way round"],
)
def test_a_camera_stands_where_the_tool_has_measured_it(file: str, text: str, tmp_path: Path) -> None:
    found = cell(tmp_path, file, text)
    assert found.diagnostics == ()
    assert found.value is not None
    camera = found.value.device("camera")
    # The optical frame is 10.6, 32.5, 12.5 mm before, left of and above the screw (realsense-ros 4.58.2, d435), and its
    # axes are z forward, x right, y down: seen along them the screw is at 32.5, 12.5, -10.6 mm.
    assert camera.mount.transform_root_to_parent.position == pytest.approx(
        (0.0175 + 0.0325, -0.07 + 0.0125, 0.05 - 0.0106)
    )
    x, y, z = camera.mount.transform_root_to_parent.apply((1.0, 0.0, 0.0))
    ahead = [one - base for one, base in zip((x, y, z), camera.mount.transform_root_to_parent.position, strict=True)]
    assert ahead == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)
    stated = there(found.value.calibrations["hand_eye"].file)
    assert (stated.path, len(stated.sha256)) == (file, 64)


@pytest.mark.parametrize(
    ("text", "more", "code", "told"),
    [
        (EASY.format(kind="eye_on_base").replace("arm_base", "arn_base"), "", "other-frames", "arn_base_link"),
        (EASY.format(kind="eye_on_base"), "", "other-frames", "does not give the pose of `camera_bottom_screw_frame`"),
        (EASY.format(kind="in_hand"), "", "invalid", "must be `eye_in_hand` or `eye_on_base`"),
        (EASY.format(kind="eye_in_hand").replace("w: 1.0", "w: 0.5"), "", "invalid", "length 1, got 0.5"),
        (EASY.format(kind="eye_in_hand").replace("0.0175", "17.5"), "", "differs", "17.5"),
        (EASY.format(kind="eye_in_hand").replace("0.0175", "175"), "", "invalid", "must be a number of meters"),
        (LAUNCH.replace("IN-HAND", "TO-HAND"), "", "other-frames", "is moved by the robot"),
        (LAUNCH.replace('"--frame-id"', '"--frame"'), "", "invalid", "`--frame-id`"),
        (PLAIN.replace("wxyz", "quaternion"), "", "invalid", "whether w is first or last"),
        (MATRIX.replace("[0, 0, 1, 0.05]", "[0, 0, -1, 0.05]"), "", "invalid", "right-handed"),
        (MATRIX.replace("[0, 0, 1, 0.05]", "[0, 0, 1.00125, 0.05]"), "", "invalid", "right-handed"),  # squared, 1.0025
        (MATRIX.replace("[0, 0, 0, 1]]", "[0.01, 0, 0, 1]]"), "", "invalid", "last row"),
        (MATRIX.replace(f"{NAMES}, ", ""), "", "other-frames", "names no frames"),
        (MATRIX.replace("arm_tool0", "arm_wrist_2_link"), "", "other-frames", "must be rigid"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_told_at_its_line(text: str, more: str, code: str, told: str, tmp_path: Path) -> None:
    mount = MOUNT if code == "differs" else "calibration"
    found = cell(tmp_path, "file.calib", text, mount, more)
    (problem,) = found.diagnostics
    assert problem.code in (f"hand-eye-{code}", f"hand-eye-of-{code}", f"{code}-hand-eye")
    assert told in f"{problem.message} {problem.help}" or told == "17.5"


def test_frames_that_the_tool_named_otherwise_are_stated_in_the_spec(tmp_path: Path) -> None:
    text = MATRIX.replace("arm_tool0", "tool0").replace("camera_color_optical_frame", "camera")
    found = cell(tmp_path, "file.json", text, more="parent: arm/tool0, child: camera/color_optical, ")
    assert found.diagnostics == ()
    assert there(found.value).device("camera").mount.transform_root_to_parent.position == pytest.approx(
        (0.05, -0.0575, 0.0394)
    )


def test_a_spec_that_says_the_same_may_stay_and_the_file_counts(tmp_path: Path) -> None:
    same = "xyz: 50.03 -57.5 39.4 mm, rpy: 90 -90 0 deg, calibration"
    found = cell(tmp_path, "wrist.calib", EASY.format(kind="eye_in_hand"), same)
    assert found.diagnostics == ()
    assert found.value is not None
    assert found.value.device("camera").mount.transform_root_to_parent.position[0] == pytest.approx(0.05, abs=1e-9)


def test_the_difference_is_told_with_what_the_file_says(tmp_path: Path) -> None:
    other = "xyz: 50 -57.5 44.4 mm, rpy: 90 -90 0 deg, calibration"
    (problem,) = cell(tmp_path, "wrist.calib", EASY.format(kind="eye_in_hand"), other).diagnostics
    assert "5.00 mm and 0.00 deg" in problem.message
    assert "xyz: 50.00 -57.50 39.40 mm" in (problem.help or "")


def test_a_fixture_may_be_measured_too(tmp_path: Path) -> None:
    (tmp_path / "fixture.json").write_text(
        '{"parent": "world", "child": "fixture_A", "xyz": [0.45, 0.1, 0.85], "xyzw": [0, 0, 0.7071068, 0.7071068]}'
    )
    spec = spec_text("ur5e_pick").replace("fixture_a: {revision", "fixture_a: {from: fixture.json, revision")
    spec = spec.replace("parent: world, xyz: 450 100 850 mm, calibration", "parent: world, calibration")
    (tmp_path / "cell.yaml").write_text(spec)
    found = linking(tmp_path / "cell.yaml")
    assert found.diagnostics == ()
    (frame,) = (frame for frame in there(found.value).frames if frame.name == "fixture_A")
    assert there(frame.transform_to_parent).rpy() == pytest.approx((0.0, 0.0, math.pi / 2), abs=1e-6)


def test_a_launch_file_is_read_and_never_run(tmp_path: Path) -> None:
    witness = tmp_path / "ran"
    text = f"open({str(witness)!r}, 'w').close()\n{LAUNCH}"
    assert cell(tmp_path, "camera_pose.launch.py", text).diagnostics == ()
    assert not witness.exists()
