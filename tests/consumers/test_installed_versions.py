"""The program that compares what is installed with the version tuple, and the one that ends a launch: both run."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.cells import EVERY_CELL, built
from tests.consumers.matrix import build
from tests.consumers.starting import plan
from tests.foreign_yaml import safe_load

_COMMIT = "3b6cf8ff9106384e72c23de7d3ba989fb6b41141"


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


def _compare(
    tmp_path: Path, pinned: dict[str, str], shown: dict[str, str] | None = None, /, **env: str
) -> tuple[int, str]:
    manifest = tmp_path / "manifest.json"
    manifest.write_text(json.dumps({"version_tuple": pinned}), encoding="utf-8")
    program = str(_program(tmp_path, "installed_versions.py"))
    where = {"ros": "system", "rmw": "package:rmw_fastrtps_cpp", **(shown or {})}
    asked = (f"{part}={where.get(part, 'package:robotiq_driver')}" for part in pinned)
    command = [sys.executable, program, "--manifest", str(manifest), *asked]
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
    assert f"gripper.driver must be robotiq_driver a29c69b, got {_COMMIT}" in said


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
    assert "gripper.driver must be robotiq_driver 0.0.2, got 0.0.1" in said
    assert "ros must be jazzy, got humble" in said
    assert "rmw must be rmw_fastrtps_cpp 8.4.4, got rmw_zenoh_cpp in RMW_IMPLEMENTATION" in said
    assert 'CELL_ACCEPT_VERSIONS: "gripper.driver: NAME; ros: NAME; rmw: NAME"' in said


def test_person_accepts_each_part_by_name_and_the_record_has_both(tmp_path: Path) -> None:
    pinned, env = {"ros": "jazzy", "kernel": "6.1"}, {"ROS_DISTRO": "humble"}
    shown = {"kernel": "system"}
    one, both = "ros: Ada", "ros: Ada; kernel: Ben"
    code, said = _compare(tmp_path, pinned, shown, **env, CELL_ACCEPT_VERSIONS=one, E=str(tmp_path))
    assert (code, '"kernel: NAME"' in said, (tmp_path / "versions.txt").exists()) == (1, True, False)
    code, said = _compare(tmp_path, pinned, shown, **env, CELL_ACCEPT_VERSIONS=both)
    assert (code, "set E to the folder of the attempt" in said) == (1, True)
    assert _compare(tmp_path, pinned, shown, **env, CELL_ACCEPT_VERSIONS=both, E=str(tmp_path))[0] == 0
    first, second = (tmp_path / "versions.txt").read_text(encoding="utf-8").splitlines()
    assert first.endswith(" accepted by Ada: ros must be jazzy, got humble")
    assert " accepted by Ben: kernel must be 6.1, got " in second
    for nobody in ("yes", "ros", "ros:", "ros: ; kernel: "):
        assert _compare(tmp_path, pinned, shown, **env, CELL_ACCEPT_VERSIONS=nobody, E=str(tmp_path))[0] == 1


def test_library_of_a_debian_package_is_compared_without_epoch_and_revision(tmp_path: Path) -> None:
    query = tmp_path / "bin/dpkg-query"
    query.parent.mkdir()
    query.write_text('#!/bin/sh\n[ "$3" = libopenarm-can-dev ] && printf 1:1.2.9-1~jammy\n', encoding="utf-8")
    query.chmod(0o755)
    shown, path = {"left.sdk": "debian:libopenarm-can-dev"}, f"{query.parent}:/usr/bin:/bin"
    assert _compare(tmp_path, {"left.sdk": "openarm_can 1.2.9"}, shown, PATH=path)[0] == 0
    code, said = _compare(tmp_path, {"left.sdk": "openarm_can 1.3.0"}, shown, PATH=path)
    assert (code, "left.sdk must be openarm_can 1.3.0, got 1.2.9" in said) == (1, True)


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_each_right_installation_is_accepted_and_everything_read_is_depended_on(cell: str) -> None:
    texts, device = built(cell).texts, built(cell).graph.cell.device
    steps = json.loads(texts["config/bring_up.json"])["real"]
    parts = {part for step in steps for part in step.get("request", {}).get("parts", ())}
    shown = dict(part.split("=") for part in parts)
    for part, where in shown.items():
        holder, _, name = part.rpartition(".")
        # A package of ROS is one that the device names as its own, never a repository of several.
        if holder and name == "driver":
            assert where == f"package:{device(holder).software.packages.driver}"
    read = {where.removeprefix("package:") for where in shown.values() if where.startswith("package:")}
    read |= set(re.findall(r"ros2 pkg xml -t version (\S+)", texts["gates/promotion.md"]))
    depended = {exec_depend.text for exec_depend in ElementTree.fromstring(texts["package.xml"]).iter("exec_depend")}
    assert read - depended == set()
    folders = set(re.findall(r"git -C src/(\S+) rev-parse", texts["gates/promotion.md"]))
    assert folders <= set(safe_load(texts.get("sources.repos", "repositories: {}"))["repositories"])


def test_library_that_the_build_of_a_driver_fetches_is_no_version_of_a_package() -> None:
    texts = built("gen3_2f").texts
    assert "arm.sdk" not in texts["config/bring_up.json"]
    assert "arm.sdk is `kortex_api 2.5.0`. The build of arm.driver fetches it" in texts["gates/promotion.md"]
    assert "arm.sdk=debian" not in texts["config/bring_up.json"]
    assert "left.sdk=debian:libopenarm-can-dev" in built("openarm_bimanual").texts["config/bring_up.json"]


def test_versions_are_the_first_thing_that_the_real_target_asks_and_the_mock_does_not() -> None:
    steps = plan("ur5e_pick", "jazzy")
    assert steps["real"][0]["request"]["kind"] == "versions"
    parts = dict(part.split("=") for part in steps["real"][0]["request"]["parts"])
    assert {"kernel", "arm.driver", "gripper.driver"} <= set(parts)
    assert "arm.firmware" not in parts  # no computer shows it
    assert not [step for step in steps["mock"] if (step.get("request") or {}).get("kind") == "versions"]


def test_each_computer_compares_what_runs_on_it() -> None:
    first, second, third = plan("fr3_hand", "humble")["real"][:3]
    assert (first["host"], second["host"]) == ("control_pc", "planner_pc")
    driving, planning = ({part.partition("=")[0] for part in step["request"]["parts"]} for step in (first, second))
    assert {"kernel", "ros2_control", "arm.driver"} <= driving
    assert "moveit" not in driving  # it runs on the other computer, whose only step compares
    assert "moveit" in planning
    assert not planning & {"ros2_control", "arm.driver"}
    assert third["name"].startswith("observe_")


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
