"""Times cellc's commands as whole processes: median of several runs after one that is not counted, and peak memory.

Run it on a quiet machine: ``python benchmarks/whole_process.py [--runs 7]``. One process at a time; it prints a
Markdown table for ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CELL = "cells/ur5e_pick/cell.yaml"


def measured(arguments: list[str], runs: int) -> tuple[float, float, float, float]:
    """Run a command repeatedly.

    Returns:
        Minimum, median and maximum wall time in s, and the largest peak memory in MB.
    """
    times, peaks = [], []
    for run in range(runs + 1):
        begin = time.perf_counter()
        pid = os.posix_spawn(
            sys.executable,
            [sys.executable, *arguments],
            os.environ,
            file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
        )
        _, status, usage = os.wait4(pid, 0)
        if os.waitstatus_to_exitcode(status) != 0:
            raise SystemExit(f"{arguments} failed")
        if run:
            times.append(time.perf_counter() - begin)
            peaks.append(usage.ru_maxrss / 1024)
    return min(times), statistics.median(times), max(times), max(peaks)


def cell_of_arms(count: int) -> str:
    """Write a spec with ``count`` arms in rows of five, each with its trajectory controller and its home pose."""
    names = [f"arm_{number}" for number in range(count)]
    spec = {
        "format": 1,
        "cell": f"arms_{count}",
        "versions": {"ros": "jazzy"},
        "devices": {
            name: {"model": "ur5e", "mount": {"parent": "world", "xyz": f"{2 * (place // 5)} {2 * (place % 5)} 0 m"}}
            for place, name in enumerate(names)
        },
        "control": {
            "update_rate": "500 Hz",
            "controllers": {"joint_states": {"type": "joint_state_broadcaster"}}
            | {
                f"{name}_trajectory": {
                    "type": "scaled_joint_trajectory",
                    "device": name,
                    "goal_time": "1 s",
                    "path_tolerance": "0.2 rad",
                    "goal_tolerance": "0.01 rad",
                }
                for name in names
            },
        },
        "motion": {
            "groups": {f"{name}_group": {"base": f"{name}/base_link", "tip": f"{name}/tool0"} for name in names},
            "poses": {"home": {f"{name}_group": "0 -90 90 -90 -90 0 deg" for name in names}},
        },
        "rehearsals": {"ready": {"steps": [{"move": "home"}]}},
    }
    return json.dumps(spec)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=7)
    runs = parser.parse_args().runs
    os.chdir(ROOT)
    with tempfile.TemporaryDirectory() as folder:
        rows = {"python -c pass": ["-c", "pass"]}
        for count in (1, 20):
            file = Path(folder) / f"arms_{count}.yaml"
            file.write_text(cell_of_arms(count))
            rows[f"check, {count} arm(s)"] = ["-m", "cellc", "check", str(file)]
            rows[f"build, {count} arm(s)"] = ["-m", "cellc", "build", str(file), "-o", folder, "--force"]
        rows |= {
            f"check {CELL}": ["-m", "cellc", "check", CELL],
            f"build {CELL} (cold folder)": ["-c", _COLD_BUILD, folder],
            f"build {CELL} (nothing changed)": ["-m", "cellc", "build", CELL],
            "mock generated/ur5e_pick (three rehearsals)": ["-m", "cellc", "mock", "generated/ur5e_pick"],
        }
        print("| command | min s | median s | max s | peak MB |\n|---|---|---|---|---|")
        for label, arguments in rows.items():
            low, middle, high, peak = measured(arguments, runs)
            print(f"| {label} | {low:.3f} | {middle:.3f} | {high:.3f} | {peak:.0f} |", flush=True)


_COLD_BUILD = f"""
import sys, shutil, pathlib
shutil.rmtree(pathlib.Path(sys.argv[1]) / "cold", ignore_errors=True)
from cellc.cli.main import main
main(["build", "{CELL}", "-o", sys.argv[1] + "/cold"])
"""

if __name__ == "__main__":
    main()
