"""Linking, rules, deployment and emitters do at most a little more than twice the work for a cell of twice the size."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from types import FrameType

from cellc.pipeline import check, emit_cell

_FIRST, _MOST = 14, 2.15


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


def _calls(size: int, folder: Path) -> int:
    file = folder / f"{size}.yaml"
    file.write_text(_cell(size), encoding="utf-8")
    assert emit_cell(check(file)).value is not None  # and what is loaded and kept once is
    counted = 0

    def count(frame: FrameType, event: str, _: object) -> None:
        nonlocal counted
        counted += event == "call" and "/cellc/" in frame.f_code.co_filename.replace("\\", "/")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        emit_cell(check(file))
    finally:
        sys.setprofile(before)
    return counted


def test_work_grows_with_the_cell_and_not_with_its_square(tmp_path: Path) -> None:
    once, twice = _calls(_FIRST, tmp_path), _calls(2 * _FIRST, tmp_path)
    assert twice <= _MOST * once, f"{once} and {twice} calls"
