"""What people tell a robot, with the figures of the cell, and who starts its program."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cells import spec_text
from tests.emit.cells import artifacts_of, emitted
from tests.foreign_yaml import safe_load

_PERSON = "program: {played_by: operator, mode: local}"
_THRESHOLDS = """\
    collision:
      torque: {lower: 25 25 22 20 19 17 14 N m, upper: 35 35 32 30 29 27 24 N m}
      force: {lower: 30 30 30 N, upper: 40 40 40 N}
      moment: {lower: 25 25 25 N m, upper: 35 35 35 N m}
"""


def _gate(text: str, code: str) -> str:
    """Return the checklist of a gate."""
    return text.split(f"\n## {code} ")[1].split("\n## ")[0]


def _ways(folder: Path, program: str) -> dict[str, str]:
    return emitted(folder, spec_text("ur5e_pick").replace(_PERSON, program))


def test_a_program_of_the_driver_is_told_to_plugin_and_helper_and_needs_remote_control(tmp_path: Path) -> None:
    # operation_modes.rst of ur_robot_driver 6.0.0: it needs remote control; ur_driver.cpp:148-160: it stops what runs.
    texts = _ways(tmp_path, "program: {played_by: driver, mode: remote}")
    robot = ElementTree.fromstring(texts["urdf/ur5e_pick.real.urdf"])
    assert [param.text for param in robot.iter("param") if param.get("name") == "headless_mode"] == ["true"]
    helper = safe_load(texts["config/drivers.yaml"])["arm_state_helper"]["ros__parameters"]
    assert helper["headless_mode"] is True
    gates = texts["gates/promotion.md"]
    assert "When the driver starts, it stops any program on the robot" in _gate(gates, "G3")
    assert "LOCAL" not in gates
    assert "resend_robot_program" in _gate(gates, "G7")
    assert "External Control URCap" not in _gate(gates, "G0")


def test_a_person_plays_at_the_pendant_or_over_the_dashboard(tmp_path: Path) -> None:
    pendant = artifacts_of("ur5e_pick")
    robot = ElementTree.fromstring(pendant["urdf/ur5e_pick.real.urdf"])
    assert [param.text for param in robot.iter("param") if param.get("name") == "headless_mode"] == ["false"]
    assert "Have operator load the External Control program and press Play" in _gate(
        pendant["gates/promotion.md"], "G7"
    )
    remote = _ways(tmp_path, "program: {played_by: operator, mode: remote}")["gates/promotion.md"]
    assert "Have operator call load_program and then play of arm_dashboard_client" in _gate(remote, "G7")
    assert "Play on the pendant does nothing in this mode" in _gate(remote, "G3")


@pytest.mark.parametrize(
    ("program", "starts"),
    [
        ("program: {played_by: operator, mode: remote}", "Call play of arm_dashboard_client"),
        ("program: {played_by: driver, mode: remote}", "Call resend_robot_program"),
    ],
    ids=["dashboard", "headless"],
)
def test_in_remote_mode_nobody_is_sent_to_a_pendant_that_starts_nothing(
    program: str, starts: str, tmp_path: Path
) -> None:
    # operation_modes.rst of 6.0.0: with remote control the pendant neither plays nor powers; services do.
    texts = _ways(tmp_path, program)
    audit = texts["audit.md"].replace("\\", "")
    for state in ("protective_stop", "emergency_stop"):
        way = audit.split(f"\narm, {state}:\n")[1].split(":\n")[0]
        assert starts in way
        assert "teach pendant" not in way
        assert "Call stop of arm_dashboard_client. Do not resume" in way
    assert "Call power_off of arm_dashboard_client" in audit
    assert "call power_on and then brake_release of arm_dashboard_client" in _gate(texts["gates/promotion.md"], "G5")


def test_the_tcp_stands_in_the_gate_as_the_pendant_shows_it() -> None:
    # By hand: the gripper is 11 mm beyond tool0 and turned by 90 deg about z, the TCP 162 mm beyond the gripper.
    gate = _gate(artifacts_of("ur5e_pick")["gates/promotion.md"], "G5")
    assert (
        "In the controller of arm, check that the TCP is frame tcp: 0.00 0.00 173.00 mm in arm_tool0"
        in gate.replace("\\", "")
    )
    assert "rotation vector 0.0000 0.0000 1.5708 rad, roll pitch yaw 0.00 0.00 90.00 deg" in gate
    assert "timeout 10 ros2 topic echo --once /arm_tcp/pose" in gate


def test_a_turn_past_the_half_is_told_as_the_shorter_one(tmp_path: Path) -> None:
    # 270 deg about z is -90 deg: a rotation vector is at most pi long.
    text = spec_text("ur5e_pick").replace(
        "tcp: {parent: gripper/base, xyz: 0 0 162 mm,", "tcp: {parent: gripper/base, xyz: 0 0 162 mm, rpy: 0 0 180 deg,"
    )
    gate = _gate(emitted(tmp_path, text)["gates/promotion.md"], "G5")
    assert "rotation vector 0.0000 0.0000 -1.5708 rad, roll pitch yaw 0.00 0.00 -90.00 deg" in gate


def test_payload_has_its_inertia_its_frame_and_who_tells_it(tmp_path: Path) -> None:
    stated = "center_of_mass: -5 5 46 mm"
    text = spec_text("fr3_hand").replace(stated, f"{stated}, inertia: 0.0011 0.0024 0.0017 0 0 0 kg m^2")
    gate = _gate(emitted(tmp_path, text)["gates/promotion.md"], "G3").replace("\\", "")
    figures = "center of mass -5 5 46 mm, inertia about that center 0.0011 0.0024 0.0017 0 0 0 kg m^2"
    assert f"Payload of arm: 0.92 kg with tool, {figures} (ixx iyy izz ixy ixz iyz) in fr3_link8. Enter" in gate


@pytest.mark.parametrize(("distro", "service"), [("humble", "/service_server"), ("jazzy", "/service_server")])
def test_collision_thresholds_stand_in_the_gate_as_a_whole_request(distro: str, service: str, tmp_path: Path) -> None:
    # franka_msgs/srv/SetFullCollisionBehavior: four torques of 7 joints, four wrenches of 6; figures of the vendor's
    # examples, default_robot_behavior_utils.hpp:25.
    text = spec_text("fr3_hand").replace("ros: humble", f"ros: {distro}")
    gate = _gate(emitted(tmp_path, text.replace("    tcp: hand/hand_tcp\n", _THRESHOLDS))["gates/promotion.md"], "G7")
    (call,) = re.findall(r"`ros2 service call (\S+) franka_msgs/srv/SetFullCollisionBehavior \"(\{.*?\})\"`", gate)
    assert call[0] == f"{service}/set_full_collision_behavior"
    torque, wrench = [25.0, 25.0, 22.0, 20.0, 19.0, 17.0, 14.0], [30.0, 30.0, 30.0, 25.0, 25.0, 25.0]
    for phase in ("acceleration", "nominal"):
        request = safe_load(call[1])
        assert len(request) == 8
        assert request[f"lower_torque_thresholds_{phase}"] == torque
        assert request[f"upper_torque_thresholds_{phase}"] == [one + 10.0 for one in torque]
        assert request[f"lower_force_thresholds_{phase}"] == wrench
        assert request[f"upper_force_thresholds_{phase}"] == [one + 10.0 for one in wrench]


def test_load_and_impedance_stand_in_the_gate_as_whole_requests(tmp_path: Path) -> None:
    # franka_msgs of 2.5.0: SetLoad has a matrix of 9 by columns, SetJointStiffness 7 figures, SetCartesianStiffness 6.
    text = spec_text("fr3_hand").replace(
        "    tcp: hand/hand_tcp\n",
        "    tcp: hand/hand_tcp\n"
        "    impedance: {joint: 3000 3000 3000 2500 2500 2000 2000 N m/rad,\n"
        "                cartesian: {translation: 2 2 1 N/mm, rotation: 200 200 100 N m/rad}}\n",
    )
    load = "load: {mass: 200 g, center_of_mass: 0 0 120 mm, inertia: 3 2 1 0.5 0.25 0.125 g m^2}"
    stated = "center_of_mass: -5 5 46 mm"
    gate = _gate(emitted(tmp_path, text.replace(stated, f"{stated}, {load}"))["gates/promotion.md"], "G7")
    calls = dict(re.findall(r"`ros2 service call /service_server/set_(\S+) franka_msgs/srv/\w+ \"(\{.*?\})\"`", gate))
    assert safe_load(calls["joint_stiffness"]) == {"joint_stiffness": [3000.0] * 3 + [2500.0] * 2 + [2000.0] * 2}
    assert safe_load(calls["cartesian_stiffness"]) == {"cartesian_stiffness": [2000, 2000, 1000, 200, 200, 100]}
    told = safe_load(calls["load"])
    assert (told["mass"], told["center_of_mass"]) == (0.2, [0.0, 0.0, 0.12])
    xx, xy, xz, yx, yy, yz, zx, zy, zz = told["load_inertia"]
    assert (xx, yy, zz) == (0.003, 0.002, 0.001)
    assert (xy, xz, yz) == (yx, zx, zy) == (0.0005, 0.00025, 0.000125)
    # communication_test.cpp of libfranka 0.20.4, the last lines: below 0.95 it warns, below 0.90 it is not sufficient.
    assert "`communication_test 172.16.0.2`" in gate
    assert "must be at least 0.95" in gate
