"""The kinematics of one very robot: what a file of the vendor's tool becomes in the description and for the driver."""

from __future__ import annotations

import hashlib
import os
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from pinocchio.rpy import rpyToMatrix

from tests.cells import diagnose, spec_text, written
from tests.emit.cells import artifacts_of, emitted, unbroken

# As ur_calibration writes it: yaml-cpp leaves the point out of `5e-06`. Figures made up, near those of the type.
_FILE = """kinematics:
  shoulder: {x: 0, y: 0, z: 0.1624, roll: -0, pitch: 0, yaw: 5e-06}
  upper_arm: {x: -9.4e-05, y: 0, z: 0, roll: 1.5707, pitch: 0, yaw: 1.2e-05}
  forearm: {x: -0.42521, y: 0, z: 0, roll: 0.0013, pitch: -0.0007, yaw: 3.1e-05}
  wrist_1: {x: -0.39248, y: 0.00021, z: 0.13351, roll: 6.2831, pitch: 0.0012, yaw: 0}
  wrist_2: {x: 8.8e-05, y: -0.0998, z: 0.0001, roll: 1.5697, pitch: 0, yaw: 0}
  wrist_3: {x: 4e-05, y: 0.0995, z: 0, roll: 1.5709, pitch: 3.1416, yaw: -3.1416}
  hash: calib_10437652789214773355
"""
_JOINTS = {
    "arm_shoulder_pan_joint": "shoulder",
    "arm_shoulder_lift_joint": "upper_arm",
    "arm_elbow_joint": "forearm",
    "arm_wrist_1_joint": "wrist_1",
    "arm_wrist_2_joint": "wrist_2",
    "arm_wrist_3_joint": "wrist_3",
}
_STATED = "    calibration: {file: ours/arm.yaml, measured: 2026-07-01, owner: robot}\n"


def _spec(tmp_path: Path, file: str = _FILE) -> str:
    (tmp_path / "ours").mkdir(exist_ok=True)
    (tmp_path / "ours" / "arm.yaml").write_text(file, encoding="utf-8")
    model = "    model: ur5e\n"
    return spec_text("ur5e_pick").replace(model, model + _STATED)


def _figures(part: str) -> dict[str, float]:
    line = next(line for line in _FILE.splitlines() if line.startswith(f"  {part}:"))
    pairs = (pair.split(": ") for pair in line.partition("{")[2].rstrip("}").split(", "))
    return {name: float(value) for name, value in pairs}


@pytest.mark.parametrize("target", ["mock", "real"])
def test_joints_of_the_description_stand_where_the_file_has_them(target: str, tmp_path: Path) -> None:
    root = ElementTree.fromstring(emitted(tmp_path, _spec(tmp_path))[f"urdf/ur5e_pick.{target}.urdf"])
    for joint, part in _JOINTS.items():
        (origin,) = (tag.find("origin") for tag in root.findall("joint") if tag.get("name") == joint)
        assert origin is not None
        expected = _figures(part)
        xyz = [float(number) for number in origin.get("xyz", "0 0 0").split()]
        assert xyz == pytest.approx([expected[name] for name in "xyz"], abs=1e-9)
        turns = [float(number) for number in origin.get("rpy", "0 0 0").split()]
        np.testing.assert_allclose(
            rpyToMatrix(*turns), rpyToMatrix(*(expected[name] for name in ("roll", "pitch", "yaw"))), atol=1e-8
        )


def test_driver_is_told_the_hash_of_the_file(tmp_path: Path) -> None:
    root = ElementTree.fromstring(emitted(tmp_path, _spec(tmp_path))["urdf/ur5e_pick.real.urdf"])
    (told,) = (tag.text for tag in root.iter("param") if tag.get("name") == "kinematics/hash")
    assert told == "calib_10437652789214773355"


def test_gates_compare_the_file_and_read_what_the_driver_says_of_it(tmp_path: Path) -> None:
    gates = unbroken(emitted(tmp_path, _spec(tmp_path))["gates/promotion.md"])
    assert hashlib.sha256(_FILE.encode()).hexdigest() in gates
    assert "sha256sum cells/ur5e_pick/ours/arm.yaml" in gates
    assert "grep -hF -e 'Calibration checked successfully'" in gates
    nominal = unbroken(artifacts_of("ur5e_pick")["gates/network.md"])  # at the end of L2: the robot is powered for it
    assert "ros2 launch ur_calibration calibration_correction.launch.py robot_ip:=192.168.56.101" in nominal


@pytest.mark.parametrize(
    ("log", "said"),
    [
        (None, ["FAILED"]),
        ("started", ["FAILED"]),
        ("Calibration checked successfully.", ["Calibration checked successfully.", "PASSED"]),
        (
            "Calibration checked successfully.\nThe calibration parameters of the connected robot don't match",
            ["The calibration parameters of the connected robot don't match", "FAILED"],
        ),
    ],
)
def test_what_the_log_says_has_a_verdict_of_its_own(log: str | None, said: list[str], tmp_path: Path) -> None:
    """Texts: ur_robot_driver@3.8.0 ur_robot_driver/src/hardware_interface.cpp, on_configure."""
    page = emitted(tmp_path, _spec(tmp_path))["gates/promotion.md"]
    block = page[page.index("    grep -lF -e ros2_control_node") :].partition("  } 2>&1")[0]
    if log is not None:
        (tmp_path / "logs/a launch").mkdir(parents=True)
        (tmp_path / "logs/a launch/launch.log").write_text(f"ros2_control_node\n{log}\n", encoding="utf-8")
    env = {**os.environ, "ROS_LOG_DIR": (tmp_path / "logs").as_posix()}
    ran = subprocess.run(
        ["bash", "-c", f"{{\n{block}\n}} 2>&1 | cat"], env=env, capture_output=True, text=True, check=False
    )
    printed = [
        line for line in ran.stdout.splitlines() if "launch.log" not in line
    ]  # of `ls`, or of `grep` that has none
    assert printed == [*said[:-1], f"{said[-1]}  log         arm: last line above"]


def test_nominal_kinematics_keep_the_real_cell_closed_until_a_file_is_named(tmp_path: Path) -> None:
    codes = [diagnosis.code for diagnosis in diagnose(written(tmp_path, spec_text("ur5e_pick")))]
    assert "nominal-kinematics" in codes
    codes = [diagnosis.code for diagnosis in diagnose(written(tmp_path, _spec(tmp_path)))]
    assert "nominal-kinematics" not in codes
    assert "implausible-kinematics" not in codes


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("kinematics:", "calibration:", 1, "`kinematics` is missing: this is not a file of `ros2`"),
        ("x: -0.42521, ", "", 4, "`kinematics.forearm.x` is missing"),
        ("z: 0.13351", "z: 133_51", 5, "`kinematics.wrist_1.z` must be a number between -100 and 100 m, got `133_51`"),
        ("roll: 0.0013", "roll: .nan", 4, "got `.nan`"),
        ("calib_10437652789214773355", "calib 17", 8, "must be letters, digits and underscores, got `calib 17`"),
        ("  hash: calib_10437652789214773355\n", "", 1, "`kinematics.hash` must be letters, digits and underscores"),
    ],
)
def test_file_in_another_form_is_refused_at_its_line(
    old: str, new: str, line: int, message: str, tmp_path: Path
) -> None:
    assert old in _FILE
    (problem,) = diagnose(written(tmp_path, _spec(tmp_path, _FILE.replace(old, new, 1))))
    assert problem.code == "invalid-kinematics"
    assert message in problem.message
    assert (problem.span.file.endswith("ours/arm.yaml"), problem.span.line) == (True, line)


def test_file_outside_the_folder_of_the_spec_is_not_read(tmp_path: Path) -> None:
    folder = tmp_path / "cell"
    folder.mkdir()
    text = _spec(tmp_path).replace("ours/arm.yaml", "../ours/arm.yaml")
    (problem,) = diagnose(written(folder, text))
    assert problem.code == "include-escape"


def test_calibration_of_a_device_whose_robots_are_alike_is_refused(tmp_path: Path) -> None:
    _spec(tmp_path)
    text = spec_text("ur5e_pick").replace("    model: robotiq_2f_85\n", "    model: robotiq_2f_85\n" + _STATED)
    (problem,) = diagnose(written(tmp_path, text))
    assert problem.code == "invalid-kinematics"
    assert "`robotiq_2f_85`" in problem.message
