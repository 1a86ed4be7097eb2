"""Times a rehearsal around real nodes: wall time, and processor time of cellc, of the bridge and of the nodes.

In a ROS environment: ``python -m benchmarks.among_nodes FOLDER --runs 20 -- --without task --lockstep --launch CMD``.
What follows `--` are the options of `cellc mock --ros`.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from statistics import median

from cellc.mock.ros.bridge import PROGRAM

_LOOK_S = 0.05
_TICKS = os.sysconf("SC_CLK_TCK")


def descendants(pid: int) -> set[int]:
    """Return the processes that a process has started, and those that they have."""
    found: set[int] = set()
    with suppress(OSError):
        for thread in Path(f"/proc/{pid}/task").iterdir():
            for child in (thread / "children").read_text().split():
                found |= {int(child)} | descendants(int(child))
    return found


def used_s(pid: int) -> float:
    """Return the processor time of a process in s."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / _TICKS


def measured(command: list[str]) -> tuple[float, dict[str, float]]:
    """Return the wall time of a command, and processor times by role; what is used within the last look is not seen."""
    began_s, seen = time.monotonic(), dict[int, tuple[str, float]]()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    while child.poll() is None:
        for pid in (child.pid, *descendants(child.pid)):
            with suppress(OSError):
                if words := Path(f"/proc/{pid}/cmdline").read_text():  # it has not ended
                    who = "cellc" if pid == child.pid else "bridge" if PROGRAM.name in words else "nodes"
                    seen[pid] = who, used_s(pid)
        time.sleep(_LOOK_S)
    times = {who: sum(spent_s for by, spent_s in seen.values() if by == who) for who in ("cellc", "bridge", "nodes")}
    if child.returncode:
        sys.exit(child.returncode)  # cellc has said why
    return time.monotonic() - began_s, times


def main() -> None:
    """Print a line for each run, and the means."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--rehearsal", default="pick_and_place")
    at = sys.argv.index("--")
    asked, more = parser.parse_args(sys.argv[1:at]), sys.argv[at + 1 :]
    command = [sys.executable, "-m", "cellc", "mock", asked.folder, "--rehearsal", asked.rehearsal, "--ros", *more]
    runs = []
    for number in range(asked.runs):
        wall_s, times = measured([*command, "--ros-python", sys.executable])
        runs.append({"wall": wall_s, **times})
        print(f"run {number + 1}: {_row(runs[-1])}", flush=True)
    print(f"median of {asked.runs}: {_row({who: median(run[who] for run in runs) for who in runs[0]})}")


def _row(times: dict[str, float]) -> str:
    return ", ".join(f"{who} {spent_s:.2f} s" for who, spent_s in times.items())


if __name__ == "__main__":
    main()
