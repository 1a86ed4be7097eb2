"""`cellc mock --ros --without task` on a real graph: right nodes of rclpy pass, wrong ones are named."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.cells import ROOT

for _name in ("rclpy", "sensor_msgs", "control_msgs", "moveit_msgs", "std_srvs", "tf2_msgs"):
    pytest.importorskip(_name)

_DOMAIN = {"gw0": "93", "gw1": "92", "gw2": "91", "gw3": "90"}.get(os.environ.get("PYTEST_XDIST_WORKER", ""), "94")
_MORE = """rehearsals:
  late_states:
    steps: [move: home, wait: 1 s, detect: object, move: pick]
    inject: {delay: arm, by: 300 ms, at: {step: 2}}
    expect: stale_state
  moved: {steps: [move: place, move: home, detect: object, move: pick]}
"""


@pytest.fixture(scope="session")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The cell with two more rehearsals, built for the distribution of this environment."""
    distro, out = os.environ["ROS_DISTRO"], tmp_path_factory.mktemp("among")
    cell = out / "cell.yaml"
    text = (ROOT / "cells/ur5e_pick/cell.yaml").read_text()
    assert text.count("\nrehearsals:") == 1
    head, _, tail = text.partition("\nrehearsals:")
    cell.write_text(f"{head}\n{_MORE}{tail.partition(chr(10))[2]}")
    command = [sys.executable, "-m", "cellc", "build", str(cell), "--matrix", f"ros={distro}", "-o", str(out)]
    subprocess.run(command, check=True, capture_output=True)
    return out / f"ros-{distro}" / "ur5e_pick"


def _run(package: Path, wrong: str, *rehearsals: str, without: str = "task", node: str = "ros_task") -> dict[str, Any]:
    started = f"{sys.executable} -m tests.consumers.{node} {package} {{rehearsal}} {wrong}".strip()
    asked = ["--ros", "--without", without, "--ros-python", sys.executable, "--domain", _DOMAIN, "--launch", started]
    chosen = [word for name in rehearsals for word in ("--rehearsal", name)]
    patience = ["--patience", "5" if wrong == "blocks" else "60"]
    ended = subprocess.run(
        [sys.executable, "-m", "cellc", "mock", str(package), *asked, "--lockstep", *patience, "--json", *chosen],
        check=False,
        capture_output=True,
        text=True,
        timeout=3600,
        cwd=ROOT,
    )
    assert ended.returncode in (0, 1), ended.stderr
    return {each["name"]: each for each in json.loads(ended.stdout)["rehearsals"]}


def test_the_right_node_passes_every_rehearsal(package: Path) -> None:
    ended = _run(package, "")
    assert len(ended) == 13
    for name, each in ended.items():
        assert each["passed"], (name, each)
        assert each["violations"] == []


def test_the_right_pair_passes_every_rehearsal_as_the_played_one(package: Path) -> None:
    command = [sys.executable, "-m", "cellc", "mock", str(package), "--json"]
    played = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["rehearsals"]
    ended = _run(package, "", without="task,perception", node="ros_pair")
    assert {name: each["outcome"] for name, each in ended.items()} == {each["name"]: each["outcome"] for each in played}
    for name, each in ended.items():
        assert each["passed"], (name, each)
        assert each["violations"] == []


_WRONGS = {
    "degrees": ("pick_and_place", "goal_outside_limits: `/task` wants joint `arm_shoulder_lift_joint` at -90"),
    "frame": ("pick_and_place", "goal_elsewhere: `/task` sent a goal to `/move_action`"),
    "latest": ("moved", "goal_elsewhere: `/task` sends no more goals"),
    "stale": ("stale_camera", "not_stopped: `/task` let its goal of `/move_action` execute"),
    "arrival": ("late_states", "commanded_on_stale_state: `/task` sent a goal to `/move_action`: joint state is"),
    "retries": ("stopped_and_resumed", "commanded_while_stopped: `/task` sent a goal to `/move_action` while"),
    "deaf": ("canceled", "cancel_ignored: `/task` let its goal of `/move_action` execute"),
    "no_look": ("lost_part", "not_stopped: `/task` let its goal of `/move_action` execute for 0.3 s more: lost"),
    "dies": ("gripper_activated", "node_ended: `/task` ended on a pose on `/object_pose` whose position is no number"),
    "blocks": ("pick_and_place", "blocked: `/task` has handled no message for"),
}


@pytest.mark.parametrize("wrong", _WRONGS)
def test_a_wrong_node_is_named(package: Path, wrong: str) -> None:
    name, text = _WRONGS[wrong]
    each = _run(package, wrong, name)[name]
    assert not each["passed"]
    assert any(line.startswith(text) for line in each["violations"]), each
