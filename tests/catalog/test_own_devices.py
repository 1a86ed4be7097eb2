"""A device folder that is held against its own description: jaws, followers, and plugins that reach nothing."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog.load import device_names, read_device
from cellc.compiler.pipeline import judge
from cellc.contract.diagnostics import Diagnostic, Severity
from tests.rules.examples import BASE, Example, diagnose_example

CODES = {"gripper-against-description", "commanded-follower", "pretended-hardware", "mimic-beyond-limits"}
FINGER = """<link name="{side}"><inertial><origin xyz="0 {center} 0.02"/><mass value="0.06"/>
<inertia ixx="0.00002" ixy="0" ixz="0" iyy="0.00002" iyz="0" izz="0.00001"/></inertial></link>
<joint name="{side}_joint" type="prismatic"><parent link="palm"/><child link="{side}"/><axis xyz="0 {axis} 0"/>
<origin xyz="0 {center} 0.06"/><limit lower="0" upper="0.04" velocity="0.1" effort="60"/>
{mimic}</joint>
"""
JAWS = (
    '<robot name="jaws"><link name="palm"/>\n'
    + FINGER.format(side="left", center="0.005", axis="1", mimic="")
    + FINGER.format(side="right", center="-0.005", axis="-1", mimic='<mimic joint="left_joint" multiplier="1"/>')
    + "</robot>\n"
)
# Two fingers of 60 mm on pivots 20 mm apart, which turn outwards as they open.
CLAW = (
    JAWS.replace("prismatic", "revolute")
    .replace('upper="0.04" velocity="0.1"', 'upper="1" velocity="4"')
    .replace("0 1 0", "-1 0 0")
)
CLAW = CLAW.replace('<axis xyz="0 -1 0"/>', '<axis xyz="1 0 0"/>')
DEVICE = """format: 1
model: jaws
vendor: demo
summary: two jaws
kind: gripper
as_of: 2026-08-01
sources: [manual]
description: {file: jaws.urdf}
base: palm
frames: {palm: palm}
packages: {}
control:
  component: '{device}_hardware'
  hardware:
    real:
      plugin: jaws_driver/JawsHardware
      parameters: {use_fake_hardware: "false", port: /dev/ttyUSB0}
      source: description
    mock: {plugin: mock_components/GenericSystem, source: mock hardware of ros2_control}
  joints:
    left_joint: {command: [position], state: [position, velocity]}
    right_joint: {state: [position, velocity]}
gripper:
  joint: left_joint
  open: 40 mm
  closed: 0 mm
  stroke: 80 mm
  max_force: 60 N
  max_speed: 0.2 m/s
  goal_tolerance: 0.5 mm
  source: data sheet
"""
TURNING = DEVICE.replace("40 mm", "1 rad").replace("0 mm\n  stroke: 80 mm", "0 rad\n  stroke: 50 mm")
TURNING = TURNING.replace("closed: 0 mm", "closed: 0 rad").replace("goal_tolerance: 0.5 mm", "goal_tolerance: 0.01 rad")


def found(folder: Path, robot: str, device: str) -> list[Diagnostic]:
    (folder / "jaws.urdf").write_text(robot, encoding="utf-8")
    (folder / "device.yaml").write_text(device, encoding="utf-8")
    diagnosed = judge(folder / "device.yaml")
    assert [str(item) for item in diagnosed if item.severity is Severity.ERROR and item.code not in CODES] == []
    return [item for item in diagnosed if item.code in CODES]


def line(text: str, part: str) -> int:
    assert text.count(part) == 1
    return text.partition(part)[0].count("\n") + 1


@pytest.mark.parametrize(("robot", "device"), [(JAWS, DEVICE), (CLAW, TURNING)], ids=["slides", "turns"])
def test_a_sound_gripper_has_no_finding(tmp_path: Path, robot: str, device: str) -> None:
    assert found(tmp_path, robot, device) == []


def test_no_device_of_the_catalog_differs_from_its_description() -> None:
    diagnosed = [item for name in device_names() for item in read_device(name).diagnostics]
    assert [str(item) for item in diagnosed if item.code in CODES] == []


CASES = {
    "swapped": ("  open: 40 mm\n  closed: 0 mm", "  open: 0 mm\n  closed: 40 mm", "  open:", "80 mm nearer"),
    "stroke of one finger": ("stroke: 80 mm", "stroke: 40 mm", "stroke:", "80 mm by the joints, got 40 mm"),
    "half of the way": ("open: 40 mm", "open: 20 mm", "stroke:", "40 mm by the joints, got 80 mm"),
    "a command for the follower": (
        "right_joint: {state: [position, velocity]}",
        "right_joint: {command: [position], state: [position, velocity]}",
        "right_joint:",
        "`right_joint` mimics `left_joint`",
    ),
    "the mock in its place": (
        "plugin: jaws_driver/JawsHardware",
        "plugin: mock_components/GenericSystem",
        "      plugin:",
        "got `mock_components/GenericSystem`",
    ),
    "a simulator in its place": (
        "plugin: jaws_driver/JawsHardware",
        "plugin: gz_ros2_control/GazeboSimSystem",
        "      plugin:",
        "got `gz_ros2_control/GazeboSimSystem`",
    ),
    "a driver that pretends": (
        'use_fake_hardware: "false"',
        'use_fake_hardware: "True"',
        "parameters:",
        "`use_fake_hardware: True`",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_the_description_does_not_say_is_reported_at_its_line(name: str, tmp_path: Path) -> None:
    old, new, at, said = CASES[name]
    assert DEVICE.count(old) == 1
    device = DEVICE.replace(old, new)
    (one,) = found(tmp_path, JAWS, device)
    assert said in one.message
    assert (Path(one.span.file).name, one.span.line) == ("device.yaml", line(device, at))


def test_a_claw_that_closes_as_it_opens_is_reported(tmp_path: Path) -> None:
    swapped = TURNING.replace("open: 1 rad", "open: 0 rad").replace("closed: 0 rad", "closed: 1 rad")
    (one,) = found(tmp_path, CLAW, swapped)
    assert (one.code, one.yaml_path) == ("gripper-against-description", ("gripper", "open"))


def test_fingers_that_run_the_same_way_are_reported_at_the_follower(tmp_path: Path) -> None:
    robot = JAWS.replace('multiplier="1"', 'multiplier="-1"')
    here = line(robot, "<mimic")
    same, beyond = sorted(found(tmp_path, robot, DEVICE), key=lambda item: item.code)
    assert same.code == "gripper-against-description"
    assert here in [related.span.line for related in same.related]
    # 0 to 40 mm times -1 is -40 mm to 0, and the limits are 0 to 40 mm.
    assert (beyond.code, beyond.span.line) == ("mimic-beyond-limits", here)
    assert "sends it from -0.04 to 0 m" in beyond.message


def test_fingers_of_which_nothing_tells_where_they_are_get_no_word(tmp_path: Path) -> None:
    # Exporters put the origins of both fingers into the palm; without inertia and shapes they may be on either side.
    robot = re.sub("<inertial>.*?</inertial>", "", JAWS, flags=re.DOTALL)
    robot = robot.replace("0 0.005 0.06", "0 0 0.06").replace("0 -0.005 0.06", "0 0 0.06")
    swapped = DEVICE.replace("  open: 40 mm\n  closed: 0 mm", "  open: 0 mm\n  closed: 40 mm")
    assert found(tmp_path, robot, swapped) == []


def test_a_mock_on_the_real_target_makes_no_mock_a_driver(tmp_path: Path) -> None:
    # The mock of every device has the plugin that one of them names for the real target, too.
    shutil.copytree(BASE / "stage", tmp_path / "two_faced")
    device = tmp_path / "two_faced" / "device.yaml"
    text = device.read_text(encoding="utf-8")
    assert text.count("stage_driver/Hardware") == 1
    device.write_text(text.replace("stage_driver/Hardware", "mock_components/GenericSystem"), encoding="utf-8")
    stage = "devices: {stage: {model: ./two_faced, revision: A, firmware: stage 1.0.0}}\n"
    diagnosed = diagnose_example(Example("yaml", stage), tmp_path)
    assert [item.code for item in diagnosed if item.code in ("driver-on-mock", "pretended-hardware")] == [
        "pretended-hardware"
    ]
