"""The generated observer in a real graph: nodes of rclpy play the cell as the package states it, and otherwise."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT, built, generated

_PLAYED = ROOT / "tests/consumers/played_graph.py"
_MESSAGES = ["rclpy", "controller_manager_msgs", "sensor_msgs", "tf2_msgs", "std_msgs", "yaml"]
for _name in _MESSAGES:
    pytest.importorskip(_name)

_RATE_HZ = 50.0
"""Nodes in Python are no faster beside other work: rates above are played, and asked for, at this one."""

_WRONGS = {
    "missing:/joint_states": "/joint_states, publishers",
    "second_publisher": "/joint_states, publishers",
    "qos:/joint_states": "/joint_states, publishers",
    "early:/task": "nodes of later gates",
    "stranger": "nodes beside the package",
    "twin": "node names",
    "silent:/object_pose": "/object_pose",
    "late:/joint_states": "/joint_states",
    "future:/joint_states": "/joint_states",
    "joint": "joint states",
    "moving": "motion",
    "nan": "joint states",
    "beyond": "joint states",
    "parent:tcp": "parents and fixed transforms",
    "moved:tcp": "parents and fixed transforms",
    "frame:tcp": "frames of the description",
    "mass": "robot_description",
    "no XML": "robot_description",
    "parameter": "",
    "state:arm_trajectory": "/controller_manager, controllers",
    "type:arm_trajectory": "/controller_manager, controllers",
    "hardware:arm_hardware": "/controller_manager, hardware",
    "lifecycle:/perception": "/perception, lifecycle",
    "missing:/perception": "/object_pose, publishers",
    "missing:/camera": "/camera/color/image_raw, publishers",
    "missing:/move_group": "/tf, subscribers",
    "missing:/arm_trajectory": "/arm_trajectory/follow_joint_trajectory, server",
    "missing:/arm_io": "/arm_io/robot_program_running, publishers",
    "missing:/claim_watch": "/arm_speed/speed_scaling, subscribers",
    "missing:/controller_manager": "/controller_manager, controllers",
    "second_server": "/arm_trajectory/follow_joint_trajectory, server",
    "commander": "/arm_trajectory/follow_joint_trajectory, clients",
    "qos:/object_pose": "/object_pose, publishers",
    "qos:/tf": "/tf, publishers",
    "volatile:/camera/color/image_raw": "/camera/color/image_raw, publishers",
    "slow:/object_pose": "/object_pose",
    "late:/object_pose": "/object_pose",
    "future:/object_pose": "/object_pose",
    "frame:/object_pose": "/object_pose",
    "silent:/camera/color/image_raw": "/camera/color/image_raw",
    "parent:arm_forearm_link": "parents and fixed transforms",
    "frame:arm_wrist_3_link": "frames of the description",
    "turned:camera_link": "parents and fixed transforms",
    "twice:tcp": "parents and fixed transforms",
    "state:gripper_action": "/controller_manager, controllers",
    "state:arm_speed": "/controller_manager, controllers",
    "type:joint_states": "/controller_manager, controllers",
    "hardware:gripper_hardware": "/controller_manager, hardware",
    "sim_time:/perception": "use_sim_time",
    "sim_time:/controller_manager": "use_sim_time",
    "slow_manager": "/controller_manager, update rate",
    "irregular": "/controller_manager, update rate",
    "overrun": "/controller_manager, missed cycles",
    "hash:/camera/color/image_raw": "type hashes",
    "says:/arm_io/safety_mode": "/arm_io/safety_mode, safety state",
    "says:/arm_io/robot_mode": "/arm_io/robot_mode, robot mode",
    "says:/arm_software/get_robot_software_version": (
        "/arm_software/get_robot_software_version, software of the robot"
    ),
}
_NEEDS = {
    "overrun": "pal_statistics_msgs/msg/StatisticsValues",
    "says:/arm_io/safety_mode": "ur_dashboard_msgs/msg/SafetyMode",
    "says:/arm_io/robot_mode": "ur_dashboard_msgs/msg/RobotMode",
    "says:/arm_software/get_robot_software_version": "ur_msgs/srv/GetRobotSoftwareVersion",
}
"""Types without which a wrong cannot be played."""


@pytest.fixture(name="package", scope="module")
def package_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A package whose interfaces have types that are installed here, at rates that Python plays."""
    folder = tmp_path_factory.mktemp("package")
    for path, text in built("ur5e_pick").texts.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    contract = json.loads((folder / "contract.json").read_text(encoding="utf-8"))
    plan = json.loads((folder / "config/observe.json").read_text(encoding="utf-8"))
    for name, interface in list(contract["interfaces"].items()):
        if _is_absent(interface["type"]):
            del contract["interfaces"][name]
            for target in ("mock", "real"):
                plan[target]["ends"].pop(name, None)
                told = plan[target].get("readings", [])
                plan[target]["readings"] = [reading for reading in told if reading["interface"] != name]
        elif interface.get("rate_hz", 0.0) > _RATE_HZ:
            interface["rate_hz"] = _RATE_HZ
        if "max_age_s" in interface:
            interface["max_age_s"] = 0.5
    (folder / "contract.json").write_text(json.dumps(contract), encoding="utf-8")
    (folder / "config/observe.json").write_text(json.dumps(plan), encoding="utf-8")
    return folder


def _is_absent(kind: str) -> bool:
    """Whether a type is not installed here; the one of the gripper is in no wheel of control_msgs."""
    package, part, name = kind.split("/")
    found = importlib.util.find_spec(package)
    return found is None or not hasattr(importlib.import_module(f"{package}.{part}"), name)


def _observed(package: Path, player: list[str], words: list[str], evidence: Path) -> tuple[int, dict[str, str]]:
    """Return the exit status, and the verdict of each subject that did not pass, but for mere figures."""
    env = {**os.environ, "ROS_DOMAIN_ID": str(10 + os.getpid() % 90), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    command = [sys.executable, *player]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=env, text=True, cwd=ROOT
    ) as played:
        assert played.stdout is not None
        assert played.stdout.readline() == "plays\n"
        program = [sys.executable, str(package / "scripts/observe"), "--package", str(package)]
        ended = subprocess.run([*program, *words, "--evidence", str(evidence)], env=env, check=False)
        played.communicate("")
    (report,) = evidence.glob("*.json")
    lines = json.loads(report.read_text(encoding="utf-8"))["lines"]
    return ended.returncode, {
        line["subject"]: line["verdict"] for line in lines if line["verdict"] not in ("PASSED", "SEEN")
    }


def _unheard() -> dict[str, str]:
    """Return what is UNKNOWN where the messages of the statistics are not installed."""
    absent = importlib.util.find_spec("pal_statistics_msgs") is None
    return {"/controller_manager, missed cycles": "UNKNOWN"} if absent else {}


@pytest.fixture(name="recording", scope="module")
def recording_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the mock records of a rehearsal."""
    pytest.importorskip("mcap")
    folder = tmp_path_factory.mktemp("recording")
    words = ("mock", generated("ur5e_pick").as_posix(), "--rehearsal", "pick_and_place", "--evidence", str(folder))
    subprocess.run([sys.executable, "-m", "cellc", *words], check=True, cwd=ROOT)
    return folder / "pick_and_place.mcap"


@pytest.mark.parametrize("silent", ["", "/object_pose", "/joint_states", "/tf_static"])
def test_a_rehearsal_of_the_mock_played_in_real_time_passes_and_what_is_silent_in_it_is_named(
    package: Path, recording: Path, silent: str, tmp_path: Path
) -> None:
    """The rehearsal lasts 11.1 s; an observer that took less than 3 s to start hears 5 s of it, from 3 s on."""
    player = ["-m", "tests.consumers.played_bag", str(package), str(recording), silent]
    code, found = _observed(package, player, ["--target", "mock", "--gate", "G7", "--for", "5"], tmp_path)
    named = {
        "": {},
        "/object_pose": {"/object_pose": "FAILED", "space for the bag": "UNKNOWN"},  # nothing has a size
        "/joint_states": {"/joint_states": "FAILED", "joint states": "FAILED", "space for the bag": "UNKNOWN"},
        "/tf_static": {"frames of the description": "FAILED"},
    }[silent]
    assert (code, found) == (int(bool(named or _unheard())), named | _unheard())


def test_the_right_graph_passes(package: Path, tmp_path: Path) -> None:
    player = [str(_PLAYED), str(package), "real", ""]
    assert _observed(package, player, ["--for", "3"], tmp_path) == (int(bool(_unheard())), _unheard())


@pytest.mark.parametrize("wrong", _WRONGS)
def test_each_wrong_is_named(package: Path, wrong: str, tmp_path: Path) -> None:
    if wrong in _NEEDS and _is_absent(_NEEDS[wrong]):
        pytest.skip(f"{_NEEDS[wrong]} is not installed")
    code, failed = _observed(package, [str(_PLAYED), str(package), "real", wrong], ["--for", "3"], tmp_path)
    assert code == 1
    assert _WRONGS[wrong] in failed or not _WRONGS[wrong]
