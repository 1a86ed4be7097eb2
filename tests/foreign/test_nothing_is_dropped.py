"""Whatever a URDF with its `<ros2_control>` can state ends in the device folder, or in a question at its head."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.tools.importing.device_text import Judged, device_facts, questions
from cellc.tools.importing.role import role_of
from cellc.tools.importing.source import Robot, read_robot

_LIMIT = '<limit lower="-2" upper="2" velocity="1" effort="10"/>'
_PLAIN = {
    "robot": "",
    "link": "",
    "inertial": '<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>',
    "visual": "",
    "collision": "",
    "shape": '<box size="1 1 1"/>',
    "joint": _LIMIT,
    "control": "",
    "type": "system",
    "hardware": "",
    "part": "",
    "command": "",
    "state": "",
}
_ROBOT = (
    '<robot name="r">{robot}<link name="a">{link}<inertial>{inertial}</inertial>'
    "<visual>{visual}<geometry>{shape}</geometry></visual><collision>{collision}<geometry>{shape}</geometry>"
    '</collision></link><link name="b"/><link name="c"/>'
    '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>{joint}</joint>'
    '<joint name="k" type="revolute"><parent link="b"/><child link="c"/>' + _LIMIT + "</joint>"
    '<ros2_control name="h" type="{type}"><hardware><plugin>vendor/Arm</plugin>{hardware}</hardware>{control}'
    '<joint name="j">{part}<command_interface name="position">{command}</command_interface>'
    '<state_interface name="position">{state}</state_interface></joint></ros2_control></robot>'
)
# Where, what is written there, and what is asked; nothing where it ends in the folder. The elements and attributes are
# those of urdfdom's xsd (urdf.xsd 1.0 and 1.2) and of the component parser of hardware_interface.
ROWS: tuple[tuple[str, str, str], ...] = (
    ("robot", '<material name="red"><color rgba="1 0 0 1"/></material>', "-"),  # of no shape: nothing to see
    ("robot", "<transmission name='t'/>", "<transmission>"),
    ("robot", "<gazebo reference='a'/>", "<gazebo>"),
    ("robot", "<sensor name='s'/>", "<sensor>"),
    ("robot", "<maker_of_it/>", "<maker_of_it>"),
    ("link", "<collision><origin xyz='1 0 0'/><geometry><sphere radius='1'/></geometry></collision>", ""),
    ("link", "<visual name='v'><geometry><cylinder radius='1' length='2'/></geometry></visual>", ""),
    ("link", "<contact><lateral_friction value='1'/></contact>", "<link/contact>"),
    (
        "inertial",
        '<origin xyz="1 0 0"/><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>',
        "",
    ),
    ("inertial", '<mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>', ""),
    ("inertial", '<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="2"/>', ""),
    ("visual", '<origin rpy="1 0 0"/>', ""),
    ("visual", '<origin quat_xyzw="0 0 0 1"/>', "quat_xyzw of <link/visual/origin>"),
    ("visual", '<material name="m"><color rgba="1 0 0 1"/></material>', ""),
    ("visual", '<material name="m"><texture filename="t.png"/></material>', "<link/visual/material/texture>"),
    ("collision", '<origin xyz="1 0 0"/>', ""),
    ("collision", '<verbose value="1"/>', "<link/collision/verbose>"),
    ("shape", '<box size="2 1 1"/>', ""),
    ("shape", '<cylinder radius="1" length="2"/>', ""),
    ("shape", '<sphere radius="1"/>', ""),
    ("shape", '<mesh filename="package://p/m.stl" scale="2 2 2"/>', "meshes that are missing, package://p/m.stl"),
    ("joint", f'{_LIMIT}<origin xyz="1 0 0" rpy="0 1 0"/>', ""),
    ("joint", f'{_LIMIT}<axis xyz="0 1 0"/>', ""),
    ("joint", '<limit lower="-1" upper="2" velocity="1" effort="10"/>', ""),
    ("joint", '<limit lower="-2" upper="1" velocity="1" effort="10"/>', ""),
    ("joint", '<limit lower="-2" upper="2" velocity="2" effort="10"/>', ""),
    ("joint", '<limit lower="-2" upper="2" velocity="1" effort="1"/>', ""),
    ("joint", _LIMIT.replace("/>", ' acceleration="3"/>'), "acceleration of <joint/limit>"),
    ("joint", _LIMIT.replace("/>", ' jerk="3"/>'), "jerk of <joint/limit>"),
    ("joint", f'{_LIMIT}<mimic joint="k" multiplier="2" offset="1"/>', ""),
    ("joint", f'{_LIMIT}<dynamics damping="1" friction="1"/>', ""),
    ("joint", f'{_LIMIT}<calibration rising="1"/>', "<joint/calibration>"),
    ("joint", f'{_LIMIT}<safety_controller k_velocity="1"/>', ""),
    ("type", "actuator", ""),
    ("type", "sensor", ""),
    ("type", 'system" rw_rate="100', "rw_rate of <ros2_control>"),
    ("type", 'system" is_async="true', "is_async of <ros2_control>"),
    ("type", 'system" thread_priority="30', "thread_priority of <ros2_control>"),
    ("hardware", '<param name="address">10.0.0.1</param>', ""),
    ("hardware", '<param name="address"></param>', ""),
    ("hardware", '<param name="address"/>', ""),
    ("hardware", "<group>g</group>", "<ros2_control/hardware/group>"),
    ("hardware", "<properties/>", "<ros2_control/hardware/properties>"),
    ("control", '<sensor name="s"><state_interface name="force.x"/></sensor>', "<ros2_control/sensor>"),
    ("control", '<gpio name="g"><command_interface name="on"/></gpio>', "<ros2_control/gpio>"),
    ("control", '<transmission name="t"/>', "<ros2_control/transmission>"),
    ("control", '<joint name="k"><command_interface name="velocity"/></joint>', "`k` takes velocity, and position"),
    ("part", '<param name="id">3</param>', "<ros2_control/joint/param>"),
    ("part", '<limits enable="false"/>', "<ros2_control/joint/limits>"),
    ("part", '<command_interface name="effort"/>', ""),
    ("command", '<param name="min">-1</param>', "<ros2_control/joint/command_interface/param>"),
    ("state", '<param name="initial_value">1</param>', "<ros2_control/joint/state_interface/param>"),
)


def _read(folder: Path, **written: str) -> Robot:
    file = folder / "r.urdf"
    file.write_text(_ROBOT.format(**{**_PLAIN, **written}), encoding="utf-8")
    read = read_robot(file, {})
    assert read.value is not None, read.diagnostics
    return read.value


def _held(robot: Robot) -> str:
    """Return what ends in the folder, without where it stood in the file: the robot, and its `device.yaml`."""
    facts = device_facts(robot, role_of(robot.description), Judged(), "2026-01-01")
    parts = (robot.description.links, robot.description.joints, facts)
    return re.sub(r"span=Span\([^)]*\)", "", repr(parts))


def _asked(robot: Robot) -> set[str]:
    role = role_of(robot.description)
    return set(questions(robot, role, Judged())) - set(role.questions())


@pytest.mark.parametrize(("where", "written", "asked"), ROWS)
def test_what_a_description_states_is_held_or_asked_about(where: str, written: str, asked: str, tmp_path: Path) -> None:
    plain, robot = _read(tmp_path), _read(tmp_path, **{where: written})
    told = " ".join(set(_asked(robot)) - set(_asked(plain)))
    if asked in ("", "-"):
        assert told == ""
        assert asked == "-" or _held(robot) != _held(plain)
    else:
        assert asked in told


@pytest.mark.parametrize("kind", ["actuator", "sensor"])
def test_component_of_another_kind_is_read_as_a_system_is(kind: str, tmp_path: Path) -> None:
    system, other = (
        device_facts(robot, role_of(robot.description), Judged(), "2026-01-01")
        for robot in (_read(tmp_path), _read(tmp_path, type=kind))
    )
    assert other["control"]["hardware"]["real"].pop("component") == kind
    assert other == system


def test_a_second_plugin_is_asked_about_and_the_real_target_stays_closed(tmp_path: Path) -> None:
    second = '<ros2_control name="g" type="actuator"><hardware><plugin>vendor/Hand</plugin></hardware>'
    second += '<joint name="k"><command_interface name="position"/><state_interface name="position"/></joint>'
    robot = _read(tmp_path, robot=f"{second}</ros2_control>")
    facts = device_facts(robot, role_of(robot.description), Judged(), "2026-01-01")
    assert list(facts["control"]["hardware"]) == ["mock"]
    assert {"j", "k"} <= set(facts["control"]["joints"])
    assert any("`g` with vendor/Hand, `h` with vendor/Arm" in question for question in _asked(robot))


def test_a_component_that_only_reads_is_asked_about(tmp_path: Path) -> None:
    second = '<ros2_control name="f" type="sensor"><hardware><plugin>vendor/Force</plugin></hardware></ros2_control>'
    read = _read(tmp_path, robot=second)
    assert any("`f` of `<ros2_control>` with vendor/Force is left out" in question for question in _asked(read))
    facts = device_facts(read, role_of(read.description), Judged(), "2026-01-01")
    assert facts["control"]["hardware"]["real"]["plugin"] == "vendor/Arm"


def test_a_component_that_ros2_control_refuses_is_asked_about(tmp_path: Path) -> None:
    robot = _read(tmp_path, type='system" rw_rate="fast')
    assert any("Could not parse rw_rate" in question for question in _asked(robot))
