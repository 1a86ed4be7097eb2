"""Writes a plant and takes it through `check`, `build` and `mock`, each in a process of its own.

``python benchmarks/plant.py [--stations 40] [--keep FOLDER] [--of-cells]``. Each station has an arm with a gripper and
eight cameras, 50 frames and 50 interfaces; 40 stations stand in a hall of 120 m. With ``--of-cells`` each station is a
cell of its own, which tells the next one by a topic, and the plant names them; a plant has no mock. Prints seconds of
processor time and the peak of memory of each command as rows of a Markdown table for ``benchmarks/README.md``.
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


def station(number: int, stations: int) -> dict[str, Json]:
    """Write the spec of a station that is a cell of its own."""
    alone = plant(1)
    nodes, interfaces, domain = alone["nodes"], alone["interfaces"], _domain(number)
    assert isinstance(nodes, dict)
    assert isinstance(interfaces, dict)
    done: dict[str, Json] = {"topic": "std_msgs/msg/Bool", "wants": "newest", "rate": "1 Hz", "max_age": "2 s"}
    done["on_stale"] = "reject_goal"
    for source in (number, number - 1):
        if not 0 <= source < stations - 1:
            continue
        bridge = f"station_{source}_to_station_{source + 1}_{domain}"
        nodes[bridge] = {"run": "domain_bridge/domain_bridge", "host": "pc_0", "owner": "team"}
        ends = ("task_0_0", bridge) if source == number else (bridge, "task_0_1")
        name = "/done" if source == number else f"/station_{source}/done"
        interfaces[name] = {**done, "from": {ends[0]: {"depth": 1}}, "to": {ends[1]: {"depth": 1}}}
    network: Json = {"domain_id": domain, "discovery": "multicast"}
    return {**alone, "cell": f"station_{number}", "network": network}


def of_cells(stations: int) -> dict[str, Json]:
    """Write the spec of a plant whose stations are cells."""
    mounts: dict[str, Json] = {
        f"station_{at}": {"parent": "world", "xyz": f"{APART_M * (at % IN_A_ROW)} {APART_M * (at // IN_A_ROW)} 0 m"}
        for at in range(stations)
    }
    return {
        "format": 1,
        "cell": f"plant_{stations}",
        "cells": {key: {"spec": f"{key}/cell.yaml", "mount": at, "owner": "team"} for key, at in mounts.items()},
        "interfaces": {
            f"/station_{at}/done": {
                "topic": "std_msgs/msg/Bool", "from": f"station_{at}/task_0_0", "to": [f"station_{at + 1}/task_0_1"],
                "owner": "team",
            }
            for at in range(stations - 1)
        },
    }  # fmt: skip


def _domain(number: int) -> int:
    return 20 + number


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
    parser.add_argument("--of-cells", action="store_true", help="each station is a cell of its own")
    parser.add_argument("--keep", type=Path, help="write the spec and the package here")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = asked.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        file, built = folder / "cell.yaml", folder / "built"
        file.write_text(json.dumps((of_cells if asked.of_cells else plant)(asked.stations), indent=1), encoding="utf-8")
        for number in range(asked.stations if asked.of_cells else 0):
            cell = folder / f"station_{number}" / "cell.yaml"
            cell.parent.mkdir(exist_ok=True)
            cell.write_text(json.dumps(station(number, asked.stations), indent=1), encoding="utf-8")
        print("| command | exit code | processor, s | peak, MB |\n|---|---|---|---|")
        building = ("build", file, "-o", built, "--force")
        for command in (("check", file), ("check", file), building, *([] if asked.of_cells else [("mock", built)])):
            code, seconds, megabytes = measure(*map(str, command))
            print(f"| {command[0]} | {code} | {seconds:.1f} | {megabytes:.0f} |", flush=True)


if __name__ == "__main__":
    main()
