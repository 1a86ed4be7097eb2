"""Times campaigns of 500 runs as whole processes: wall and processor time, and the peak memory of one process.

Run it on a quiet machine: ``python benchmarks/campaign.py [--runs 500] [--jobs 2] [FOLDER ...]``. Where a cell has
fewer runs with one fault, pairs of faults fill up. It prints a Markdown table for ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

from cellc.mock import load
from cellc.mock.campaign.campaign import make_plan
from cellc.mock.faults.registry import possible_faults

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("generated/minimal", "generated/ur5e_pick", "generated/fr3_hand")


def singles(folder: str) -> int:
    """Return the number of runs with one fault."""
    cell = load(Path(folder))
    return sum(1 for _ in make_plan(cell, possible_faults(cell.contract), 0)[0].singles())


def timed(folder: str, pairs: int, jobs: int) -> tuple[float, float, float, int, int]:
    """Run a campaign.

    Returns:
        Wall and processor time in s, peak memory of the largest process in MB, runs, and those that failed.
    """
    command = ["-m", "cellc", "campaign", folder, "--json", "--pairs", str(pairs), "--jobs", str(jobs)]
    with tempfile.TemporaryFile() as output:
        begin = time.perf_counter()
        pid = os.posix_spawn(
            sys.executable,
            [sys.executable, *command],
            os.environ,
            file_actions=[(os.POSIX_SPAWN_DUP2, output.fileno(), 1)],
        )
        _, status, usage = os.wait4(pid, 0)  # its workers, which it has waited for, are in the figures
        wall_s = time.perf_counter() - begin
        if os.waitstatus_to_exitcode(status) not in (0, 1):
            raise SystemExit(f"{command} failed")
        output.seek(0)
        runs = json.load(output)["runs"]
    failed = sum(not run["passed"] for run in runs)
    return wall_s, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, len(runs), failed


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", default=FOLDERS)
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    os.chdir(ROOT)
    print("| campaign | runs | failed | wall s | processor s | peak MB |\n|---|---|---|---|---|---|")
    for folder in options.folders:
        pairs = max(0, options.runs - singles(folder))
        wall_s, processor_s, peak, runs, failed = timed(folder, pairs, options.jobs)
        print(f"| {folder} | {runs} | {failed} | {wall_s:.1f} | {processor_s:.1f} | {peak:.0f} |", flush=True)


if __name__ == "__main__":
    main()
