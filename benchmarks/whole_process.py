"""Times cellc's commands as whole processes: median of several runs after one that is not counted, and peak memory.

Run it on a quiet machine: ``python benchmarks/whole_process.py [--runs 7]``. One process at a time, with a cache of its
own; it prints a Markdown table for ``benchmarks/README.md``. Wall time is what a person waits; the time on the
processor says more where others use the machine too.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CELL = "cells/ur5e_pick/cell.yaml"


@dataclass(frozen=True)
class Row:
    """One command, and whether the cache, which holds what shapes and joints allow, is emptied before each run."""

    label: str
    arguments: list[str]
    is_first: bool = False


def environment(cache: Path) -> dict[str, str]:
    """Return that of a user, whose Python keeps compiled modules: the first run, which is not counted, makes them."""
    without = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return without | {"XDG_CACHE_HOME": str(cache), "PYTHONPYCACHEPREFIX": str(cache / "modules")}


def measured(row: Row, cache: Path, runs: int) -> tuple[float, float, float, float, float]:
    """Run a command repeatedly.

    Returns:
        Minimum, median and maximum wall time in s, median time on the processor in s, largest peak memory in MB.
    """
    times, used, peaks = [], [], []
    for run in range(runs + 1):
        if row.is_first:
            shutil.rmtree(cache / "cellc", ignore_errors=True)
        begin = time.perf_counter()
        pid = os.posix_spawn(
            sys.executable,
            [sys.executable, *row.arguments],
            environment(cache),
            file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
        )
        _, status, usage = os.wait4(pid, 0)
        if os.waitstatus_to_exitcode(status) != 0:
            raise SystemExit(f"{row.arguments} failed")
        if run:
            times.append(time.perf_counter() - begin)
            used.append(usage.ru_utime + usage.ru_stime)
            peaks.append(usage.ru_maxrss / 1024)
    return min(times), statistics.median(times), max(times), statistics.median(used), max(peaks)


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


def rows(folder: str) -> Iterator[Row]:
    """Yield what is measured; ``folder`` takes specs and artifacts."""
    yield Row("python -c pass", ["-c", "pass"])
    yield Row("cellc --help", _cellc("--help"))
    for count in (1, 20):
        file = Path(folder) / f"arms_{count}.yaml"
        file.write_text(cell_of_arms(count))
        yield Row(f"check, {count} arm(s)", _cellc("check", str(file)))
        yield Row(f"build, {count} arm(s)", _cellc("build", str(file), "-o", folder, "--force"))
    build = _cellc("build", CELL, "-o", folder)
    yield Row(f"check {CELL}, first on a machine", _cellc("check", CELL), is_first=True)
    yield Row(f"check {CELL}", _cellc("check", CELL))
    yield Row(f"build {CELL}, first on a machine", build, is_first=True)
    yield Row(f"build {CELL}", build)
    yield Row(f"build --check {CELL}", _cellc("build", "--check", CELL))
    yield Row("mock generated/ur5e_pick (all rehearsals)", _cellc("mock", "generated/ur5e_pick"))


def _cellc(*arguments: str) -> list[str]:
    return ["-m", "cellc", *arguments]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=7)
    runs = parser.parse_args().runs
    os.chdir(ROOT)
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as cache:
        print("| command | min s | median s | max s | CPU s | peak MB |\n|---|---|---|---|---|---|")
        for row in rows(folder):
            low, middle, high, used, peak = measured(row, Path(cache), runs)
            print(f"| {row.label} | {low:.3f} | {middle:.3f} | {high:.3f} | {used:.3f} | {peak:.0f} |", flush=True)


if __name__ == "__main__":
    main()
