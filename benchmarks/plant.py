"""Writes a plant and takes it through `check`, `build` and `mock`, each in a process of its own.

``python benchmarks/plant.py [--stations 40] [--keep FOLDER]``. Each station has an arm with a gripper and eight
cameras, 50 frames and 50 interfaces; 40 stations stand in a hall of 120 m. Prints seconds of processor time and the
peak of memory of each command as rows of a Markdown table for ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TypeAlias

ROOT = Path(__file__).resolve().parents[1]
Json: TypeAlias = "dict[str, Json] | list[Json] | str | int | bool"

IN_A_ROW, APART_M, CAMERAS, FRAMES, TOPICS = 8, 15, 8, 40, 48
_DOWN = "-90 -90 90 -90 -90 0 deg"


def plant(stations: int) -> dict[str, Json]:
    """Write a spec with a number of stations that have nothing in common but the hall."""
    numbers = range(stations)
    return {
        "format": 1,
        "cell": f"plant_{stations}",
        "versions": {"ros": "jazzy"},
        "hosts": {f"pc_{at}": {"scheduling": "preempt_rt"} for at in numbers},
        "devices": {name: device for at in numbers for name, device in _devices(at).items()},
        "frames": {f"work_{at}_{frame}": _frame(at, frame) for at in numbers for frame in range(FRAMES)},
        "nodes": {f"task_{at}_{end}": {"run": "tasks/node", "host": f"pc_{at}", "owner": "team"}
                  for at in numbers for end in range(2)},
        "interfaces": {f"/station_{at}/topic_{topic}": _topic(at) for at in numbers for topic in range(TOPICS)},
        "managers": {f"control_{at}": _manager(at) for at in numbers},
        "motion": {
            "groups": {f"arm_{at}": {"base": f"arm_{at}/base_link", "tip": f"arm_{at}/tool0"} for at in numbers},
            "poses": {f"ready_{at}": {f"arm_{at}": _DOWN} for at in numbers},
        },
        "rehearsals": {"all": {"steps": [{"move": f"ready_{at}"} for at in numbers]}},
    }  # fmt: skip


def _devices(at: int) -> dict[str, Json]:
    across, along = APART_M * (at % IN_A_ROW), APART_M * (at // IN_A_ROW)
    cameras: dict[str, Json] = {
        f"camera_{at}_{number}": {
            "model": "realsense_d435i",
            "mount": {"parent": "world", "xyz": f"{across + number - 4} {along + 2} 2 m", "rpy": "0 90 0 deg"},
        }
        for number in range(CAMERAS)
    }
    return {
        f"arm_{at}": {
            "model": "ur5e",
            "mount": {"parent": "world", "xyz": f"{across} {along} 0.8 m"},
            "limits": {"velocity": "50 %", "acceleration": "50 %"},
        },
        f"gripper_{at}": {"model": "robotiq_2f_85", "mount": {"parent": f"arm_{at}/tool0", "xyz": "0 0 11 mm"}},
        **cameras,
    }


def _frame(at: int, frame: int) -> Json:
    parent = f"arm_{at}/base_link" if frame % 5 == 0 else f"work_{at}_{frame - 1}"
    return {"parent": parent, "xyz": "0.1 0 0 m", "designed": True}


def _topic(at: int) -> Json:
    return {
        "topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": f"arm_{at}/base_link", "rate": "10 Hz",
        "max_age": "200 ms", "on_stale": "reject_goal",
        "from": {f"task_{at}_0": {"depth": 1}}, "to": {f"task_{at}_1": {"depth": 1}},
    }  # fmt: skip


def _manager(at: int) -> Json:
    return {
        "update_rate": "500 Hz",
        "namespace": f"/station_{at}",
        "host": f"pc_{at}",
        "controllers": {
            f"states_{at}": {"type": "joint_state_broadcaster"},
            f"trajectory_{at}": {
                "type": "scaled_joint_trajectory", "device": f"arm_{at}", "goal_time": "1 s", "client": f"task_{at}_0",
                "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad",
            },
        },
    }  # fmt: skip


def measure(*arguments: str) -> tuple[int, float, float]:
    """Run a command of cellc; return its exit code, seconds of processor time and megabytes at its peak."""
    ran = subprocess.Popen([sys.executable, "-m", "cellc", *arguments], cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(ran.pid, 0)
    return os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stations", type=int, default=40)
    parser.add_argument("--keep", type=Path, help="write the spec and the package here")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = asked.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        file, built = folder / "cell.yaml", folder / "built"
        file.write_text(json.dumps(plant(asked.stations), indent=1), encoding="utf-8")
        print("| command | exit code | processor, s | peak, MB |\n|---|---|---|---|")
        for command in (("check", file), ("check", file), ("build", file, "-o", built, "--force"), ("mock", built)):
            code, seconds, megabytes = measure(*map(str, command))
            print(f"| {command[0]} | {code} | {seconds:.1f} | {megabytes:.0f} |", flush=True)


if __name__ == "__main__":
    main()
