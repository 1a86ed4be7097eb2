"""The program that compares what is installed with the version tuple, and the one that ends a launch: both run."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.consumers.matrix import build
from tests.consumers.starting import plan

_COMMIT = "3b6cf8ff9106384e72c23de7d3ba989fb6b41141"
_WORD = "I_HAVE_READ_THE_DIFFERENCES"


def _program(tmp_path: Path, name: str, distro: str = "jazzy") -> Path:
    file = tmp_path / name
    file.write_text(build("ur5e_pick", distro).texts[f"scripts/{name}"], encoding="utf-8")
    return file


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace whose one package calls itself 0.0.1, as it stands at a commit of its source."""
    share = tmp_path / "ws/install/robotiq_driver/share/robotiq_driver"
    source = tmp_path / "ws/src/ros2_robotiq_gripper/robotiq_driver"
    for folder in (share, source):
        folder.mkdir(parents=True)
        text = "<package><name>robotiq_driver</name><!-- <version>9</version> --><version>0.0.1</version></package>"
        (folder / "package.xml").write_text(text, encoding="utf-8")
    git = source.parent / ".git"
    git.mkdir()
    (git / "HEAD").write_text("ref: refs/heads/main\n", encoding="utf-8")
    (git / "packed-refs").write_text(f"# pack-refs\n{_COMMIT} refs/heads/main\n", encoding="utf-8")
    return tmp_path / "ws"


def _compare(tmp_path: Path, pinned: dict[str, str], **env: str) -> tuple[int, str]:
    manifest = tmp_path / "manifest.json"
    manifest.write_text(json.dumps({"version_tuple": pinned}), encoding="utf-8")
    program = str(_program(tmp_path, "installed_versions"))
    command = [sys.executable, program, "--manifest", str(manifest), *pinned]
    ended = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert not ended.stderr
    return ended.returncode, ended.stdout


def _prefix(workspace: Path) -> str:
    return str(workspace / "install/robotiq_driver")


def test_commit_is_read_in_the_source_beside_the_installation(tmp_path: Path, workspace: Path) -> None:
    there = {"AMENT_PREFIX_PATH": f"/opt/nothing:{_prefix(workspace)}"}
    assert _compare(tmp_path, {"gripper.driver": "robotiq_driver 3b6cf8f"}, **there)[0] == 0
    code, said = _compare(tmp_path, {"gripper.driver": "robotiq_driver a29c69b"}, **there)
    assert code == 1
    assert f"gripper.driver must be robotiq_driver a29c69b, is {_COMMIT}" in said


def test_commit_without_a_source_is_told_as_not_provable_and_stops_nothing(tmp_path: Path, workspace: Path) -> None:
    (workspace / "src/ros2_robotiq_gripper/.git/HEAD").unlink()
    (workspace / "src").rename(workspace / "elsewhere")
    pinned = {"gripper.driver": "robotiq_driver 3b6cf8f"}
    code, said = _compare(tmp_path, pinned, AMENT_PREFIX_PATH=_prefix(workspace))
    assert (code, "cannot be checked" in said) == (0, True)
    # A package that is not there at all is a difference, whatever it is pinned by.
    assert _compare(tmp_path, pinned, AMENT_PREFIX_PATH="/opt/nothing")[0] == 1


def test_number_of_a_package_distribution_and_middleware_are_told_with_both_figures(
    tmp_path: Path, workspace: Path
) -> None:
    pinned = {"gripper.driver": "robotiq_driver 0.0.2", "ros": "jazzy", "rmw": "rmw_fastrtps_cpp 8.4.4"}
    env = {"AMENT_PREFIX_PATH": _prefix(workspace), "ROS_DISTRO": "humble", "RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}
    code, said = _compare(tmp_path, pinned, **env)
    assert code == 1
    assert "gripper.driver must be robotiq_driver 0.0.2, is 0.0.1" in said
    assert "ros must be jazzy, is humble" in said
    assert "rmw must be rmw_fastrtps_cpp 8.4.4, is rmw_zenoh_cpp in RMW_IMPLEMENTATION" in said
    assert f"CELL_ACCEPT_VERSIONS={_WORD}" in said


def test_person_goes_on_with_a_word_that_is_written_into_the_record_of_the_attempt(tmp_path: Path) -> None:
    pinned, word = {"ros": "jazzy"}, {"ROS_DISTRO": "humble", "CELL_ACCEPT_VERSIONS": _WORD}
    code, said = _compare(tmp_path, pinned, **word)
    assert (code, "set E to the folder of the attempt" in said) == (1, True)
    assert _compare(tmp_path, pinned, **word, E=str(tmp_path))[0] == 0
    assert (tmp_path / "versions.txt").read_text(encoding="utf-8").endswith(f"{_WORD} ros must be jazzy, is humble\n")
    assert _compare(tmp_path, pinned, ROS_DISTRO="humble", CELL_ACCEPT_VERSIONS="yes", E=str(tmp_path))[0] == 1


def test_versions_are_the_first_thing_that_the_real_target_asks_and_the_mock_does_not() -> None:
    steps = plan("ur5e_pick", "jazzy")
    assert steps["real"][0]["request"]["kind"] == "versions"
    assert {"kernel", "arm.driver", "gripper.driver"} <= set(steps["real"][0]["request"]["parts"])
    assert "arm.firmware" not in steps["real"][0]["request"]["parts"]  # no computer shows it
    assert not [step for step in steps["mock"] if (step.get("request") or {}).get("kind") == "versions"]


def test_each_computer_compares_what_runs_on_it() -> None:
    first, second = plan("fr3_hand", "humble")["real"][:2]
    assert first["host"] == "control_pc"
    assert {"kernel", "ros2_control", "arm.driver"} <= set(first["request"]["parts"])
    assert "moveit" not in first["request"]["parts"]  # it runs on the other computer, which takes no step
    assert second["name"].startswith("observe_")


def test_launch_ends_with_a_required_program_but_not_when_it_was_asked_to_end(tmp_path: Path) -> None:
    # Humble's launch XML has no on_exit: a dead controller manager would leave all else waiting for ever.
    required = _program(tmp_path, "required", "humble")
    started = "import subprocess, sys; sys.exit(subprocess.Popen(sys.argv[1:]).wait())"
    for needed, expected in (("true", -signal.SIGINT), ("sleep 60", 128 + signal.SIGINT)):
        launch = subprocess.Popen(
            [sys.executable, "-c", started, sys.executable, required, "--", *needed.split()],
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        if expected > 0:
            subprocess.run(["kill", "-INT", str(_child_of(launch.pid))], check=True)
        assert launch.wait(20) == expected


def _child_of(pid: int) -> int:
    for _ in range(200):
        found = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8").split()
        inner = found and Path(f"/proc/{found[0]}/task/{found[0]}/children").read_text(encoding="utf-8").split()
        if inner:
            return int(found[0])
        time.sleep(0.05)
    raise AssertionError("the program was not started")
