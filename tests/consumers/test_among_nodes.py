"""`cellc mock --ros` on a real graph: the right node passes, wrong ones are named, and kills leave nothing behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import Any

import pytest

from cellc.mock.ros.bridge import PROGRAM
from tests.cells import ROOT

for _name in ("rclpy", "sensor_msgs", "geometry_msgs", "tf2_msgs", "lifecycle_msgs"):
    pytest.importorskip(_name)

_NODE = ROOT / "tests/consumers/ros_perception.py"
_MARK = "CELLC_TEST_OF"
_DOMAIN = {"gw0": "98", "gw1": "97", "gw2": "96", "gw3": "95"}.get(os.environ.get("PYTEST_XDIST_WORKER", ""), "99")


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The cell, built for the distribution of this environment."""
    distro, out = os.environ["ROS_DISTRO"], tmp_path_factory.mktemp("among")
    cell = ROOT / "cells/ur5e_pick/cell.yaml"
    command = [sys.executable, "-m", "cellc", "build", str(cell), "--matrix", f"ros={distro}", "-o", str(out)]
    subprocess.run(command, check=True, capture_output=True)
    return out / f"ros-{distro}" / "ur5e_pick"


def _command(package: Path, wrong: str, *more: str) -> list[str]:
    node = f"{sys.executable} {_NODE} {wrong}".strip()
    asked = ["--ros", "--without", "perception", "--ros-python", sys.executable, "--domain", _DOMAIN, "--launch", node]
    return [sys.executable, "-m", "cellc", "mock", str(package), *asked, *more]


def _run(package: Path, wrong: str, *rehearsals: str) -> dict[str, Any]:
    chosen = [word for name in rehearsals for word in ("--rehearsal", name)]
    command = _command(package, wrong, "--lockstep", "--json", *chosen)
    ended = subprocess.run(command, check=False, capture_output=True, text=True, timeout=900)
    assert ended.returncode in (0, 1), ended.stderr
    return {each["name"]: each for each in json.loads(ended.stdout)["rehearsals"]}


def test_the_right_node_passes_every_rehearsal(package: Path) -> None:
    for name, each in _run(package, "").items():
        assert each["passed"], (name, each)
        assert each["violations"] == []


_WRONGS = {
    "arrival": "stamp_of_another_time: `/object_pose` is stamped",
    "frame": "wrong_frame: `/object_pose` is in frame `world`",
    "nan": "invalid_pose: `/object_pose` has position",
    "stale": "stale_input_used: `/object_pose` was seen in an image",
    "best_effort": "qos_of_another_profile: `/perception` is on `/object_pose` as `best_effort`",
    "silent": "too_slow: no pose from `perception`",
    "dies": "node_ended: ",
}


@pytest.mark.parametrize("wrong", _WRONGS)
def test_a_wrong_node_is_named(package: Path, wrong: str) -> None:
    each = _run(package, wrong, "pick_and_place")["pick_and_place"]
    assert not each["passed"]
    assert any(line.startswith(_WRONGS[wrong]) for line in each["violations"]), each


def test_a_pose_in_millimeters_ends_in_planning(package: Path) -> None:
    each = _run(package, "millimeters", "pick_and_place")["pick_and_place"]
    assert each["outcome"] == "planning_failure"


def test_a_second_cell_on_the_domain_is_refused(package: Path) -> None:
    first = subprocess.Popen(
        _command(package, "", "--pace", "0.2", "--rehearsal", "pick_and_place"),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        _await(lambda: any(_children(int(bridge)) for bridge in _children(first.pid)))
        second = subprocess.run(_command(package, ""), check=False, capture_output=True, text=True, timeout=300)
        assert second.returncode == 2
        assert "another cell is played on this domain" in second.stderr
    finally:
        first.terminate()
        first.wait()


def test_a_client_of_the_controller_manager_is_answered(package: Path) -> None:
    pytest.importorskip("controller_manager_msgs")
    cell = subprocess.Popen(
        _command(package, "", "--pace", "0.1", "--rehearsal", "pick_and_place"),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        client = [sys.executable, str(ROOT / "tests/consumers/ros_manager_client.py"), "arm_speed"]
        graph = {**os.environ, "ROS_DOMAIN_ID": _DOMAIN, "ROS_LOCALHOST_ONLY": "1"}
        told = subprocess.run(client, env=graph, capture_output=True, text=True, timeout=600, check=True).stdout
    finally:
        cell.terminate()
        cell.wait()
    answers = json.loads(told)
    assert answers["components"]["arm_hardware"] in ("inactive", "active")
    assert answers["switched"]
    assert "joint_states" in answers["before"]
    assert answers["after"] == {**answers["before"], "arm_speed": "inactive"}


@pytest.mark.parametrize("number", range(int(os.environ.get("CELLC_KILLS", "9"))))
def test_a_kill_leaves_nothing(package: Path, number: int) -> None:
    random, whom = Random(number), ("", PROGRAM.name, _NODE.name)[number % 3]
    mark = f"{os.getpid()}-{number}"
    command = _command(package, "", "--rehearsal", "pick_and_place", "--pace", "4")
    child = subprocess.Popen(
        command, env={**os.environ, _MARK: mark}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    _await(lambda: len(_ours(mark)) == 3)
    time.sleep(random.uniform(0.0, 3.0))
    others = (pid for pid, words in _ours(mark).items() if pid != child.pid and whom in words)
    os.kill(next(others) if whom else child.pid, signal.SIGKILL)
    child.communicate(timeout=120)
    _await(lambda: not _ours(mark))
    assert not _ours(mark)


def _children(pid: int) -> list[str]:
    file = Path(f"/proc/{pid}/task/{pid}/children")
    return file.read_text().split() if file.exists() else []


def _ours(mark: str) -> dict[int, str]:
    """Return what runs with a mark in its environment, with its words."""
    found = {}
    for entry in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it has ended since
            if f"{_MARK}={mark}".encode() in (entry / "environ").read_bytes():
                found[int(entry.name)] = (entry / "cmdline").read_text().replace("\0", " ")
    return found


def _await(holds: Any, within_s: float = 60.0) -> None:
    until_s = time.monotonic() + within_s
    while not holds() and time.monotonic() < until_s:
        time.sleep(0.05)
