"""Linking, rules, deployment and emitters do at most a little more than twice the work for a cell of twice the size."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType

from cellc.compiler.pipeline import check, emit_cell

_FIRST, _MANY, _MOST = 14, 250, 2.15


def _cell(size: int) -> str:
    names = range(size)
    topic = {
        "topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": "world", "rate": "10 Hz",
        "max_age": "200 ms", "on_stale": "reject_goal",
    }  # fmt: skip
    trajectory = {
        "type": "scaled_joint_trajectory", "goal_time": "1 s", "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad"
    }  # fmt: skip
    places = [f"{1.5 * (name // 8)} {1.5 * (name % 8)} 0 m" for name in names]
    spec = {
        "format": 1,
        "cell": "large",
        "versions": {"ros": "jazzy"},
        "devices": {f"d{n}": {"model": "ur5e", "mount": {"parent": "world", "xyz": places[n]}} for n in names},
        "nodes": {f"n{n}": {"run": "tasks/node", "owner": "team", "lifecycle": n % 2 == 1} for n in names},
        "interfaces": {
            f"/t{n}": {**topic, "from": {f"n{n}": {"depth": 1}}, "to": {f"n{(n + 1) % size}": {"depth": 1}}}
            for n in names
        },
        "control": {
            "update_rate": "500 Hz",
            "controllers": {"joint_states": {"type": "joint_state_broadcaster"}}
            | {f"c{n}": {**trajectory, "device": f"d{n}", "client": f"n{n}"} for n in names},
        },
    }
    return json.dumps(spec)


def _stands(size: int) -> str:
    """Return the cell with a device without joints or controllers in the place of each arm."""
    spec = json.loads(_cell(size))
    for device in spec["devices"].values():
        device["model"] = "pedestal"
    spec["control"]["controllers"] = {"joint_states": {"type": "joint_state_broadcaster"}}
    return json.dumps(spec)


def _calls(text: str, folder: Path, work: Callable[[Path], object]) -> int:
    file = folder / "cell.yaml"
    file.write_text(text, encoding="utf-8")
    assert work(file) is not None  # and what is loaded and kept once is
    counted = 0

    def count(frame: FrameType, event: str, _: object) -> None:
        nonlocal counted
        counted += event == "call" and "/cellc/" in frame.f_code.co_filename.replace("\\", "/")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        work(file)
    finally:
        sys.setprofile(before)
    return counted


def test_work_grows_with_the_cell_and_not_with_its_square(tmp_path: Path) -> None:
    once, twice = (
        _calls(_cell(size), tmp_path, lambda file: emit_cell(check(file)).value) for size in (_FIRST, 2 * _FIRST)
    )
    assert twice <= _MOST * once, f"{once} and {twice} calls"


def test_a_check_of_many_devices_grows_with_their_number(tmp_path: Path) -> None:
    # Few calls for each device, and many devices: what looks at all of them for each one is most of the work.
    once, twice = (_calls(_stands(size), tmp_path, lambda file: check(file).graph) for size in (_MANY, 2 * _MANY))
    assert twice <= _MOST * once, f"{once} and {twice} calls"
