"""Times runs of a sweep: by processes here, by workers of a Dask cluster on loopback, and what very many would take.

Run it on a quiet machine: ``python benchmarks/sweep.py [--runs 400] [--jobs 2] [--dask] [FOLDER]``. No verdict ends
the sweep early. The rate is that of the last four fifths of the runs, so that no start is in it; processor time is that
of all processes, less that of a sweep of a tenth as many runs. It prints a Markdown table for ``benchmarks/README.md``.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from cellc.contract.compute.cluster import cluster
from cellc.contract.compute.processes import processes
from cellc.contract.compute.work import ExecutorFactory
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from cellc.mock.sweep.sweep import SweepRun, sweep

ROOT = Path(__file__).resolve().parents[1]
LOOPBACK = "127.0.0.1"
MANY, MACHINES, CORES = 10_000_000, 100, 8


@dataclass(frozen=True, slots=True)
class Measured:
    """What a number of runs took: runs a second without the start, and bytes of the journal of each run."""

    rate_hz: float
    wall_s: float
    bytes_each: float


def endless(folder: Path) -> MockCell:
    """Return a cell of which nothing is expected, so that no verdict ends a sweep."""
    read = load(folder).folder
    if read.uncertainty is None:
        raise SystemExit(f"{folder} draws nothing")
    return cell_of(replace(read, uncertainty=read.uncertainty.model_copy(update={"expected": {}})))


def measured(cell: MockCell, rehearsal: str, runs: int, factory: ExecutorFactory) -> Measured:
    """Sweep a rehearsal."""
    ended_s: list[float] = []
    written = 0

    def keep(run: SweepRun) -> None:
        nonlocal written
        ended_s.append(time.perf_counter())
        written += len(json.dumps(asdict(run), separators=(",", ":"))) + 1

    begun_s = time.perf_counter()
    sweep(cell, cell.entry(rehearsal), seed=1, most=runs, factory=factory, known={}, keep=keep)
    first = runs // 5
    rate_hz = (runs - 1 - first) / (ended_s[-1] - ended_s[first])
    return Measured(rate_hz, time.perf_counter() - begun_s, written / runs)


def processor_s() -> float:
    """Return the processor time of this process and of those that it has waited for."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


@contextmanager
def dask(workers: int) -> Iterator[str]:
    """Run a scheduler and workers of one thread each, by their own commands; yield the address."""
    with socket.socket() as free:
        free.bind((LOOPBACK, 0))
        port = str(free.getsockname()[1])
    address = f"tcp://{LOOPBACK}:{port}"
    commands = [["scheduler", "--host", LOOPBACK, "--port", port]]
    commands += [["worker", address, "--nthreads", "1", "--no-nanny"]] * workers
    with tempfile.TemporaryDirectory() as folder:
        started = [
            subprocess.Popen(
                [sys.executable, "-m", "dask", *words, "--no-dashboard"], cwd=folder, stderr=subprocess.DEVNULL
            )
            for words in commands
        ]
        try:
            yield address
        finally:
            for process in reversed(started):
                process.terminate()
                process.wait()


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default="generated/ur5e_pick")
    parser.add_argument("--rehearsal", default="pick_and_place")
    parser.add_argument("--runs", type=int, default=400)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--dask", action="store_true", help="workers of a Dask cluster too")
    options = parser.parse_args()
    os.chdir(ROOT)
    cell, few = endless(Path(options.folder)), max(10, options.runs // 10)
    before_s = processor_s()
    measured(cell, options.rehearsal, few, processes(options.jobs))
    between_s = processor_s()
    here = measured(cell, options.rehearsal, options.runs, processes(options.jobs))
    each_ms = (processor_s() - between_s - (between_s - before_s)) / (options.runs - few) * 1e3
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print("| who | runs | runs a second | wall s | processor ms a run | journal, bytes a run | peak MB of one |")
    print("|---|---|---|---|---|---|---|")
    row = (
        f"{options.runs} | {here.rate_hz:.1f} | {here.wall_s:.1f} | {each_ms:.1f} | {here.bytes_each:.0f} | {peak:.0f}"
    )
    print(f"| {options.jobs} processes | {row} |", flush=True)
    if options.dask:
        with dask(options.jobs) as address:
            measured(cell, options.rehearsal, few, cluster(address))
            there = measured(cell, options.rehearsal, options.runs, cluster(address))
        share = there.rate_hz / here.rate_hz
        print(f"| {options.jobs} workers of Dask | {options.runs} | {there.rate_hz:.1f} | {there.wall_s:.1f} | | | |")
        print(f"\nDask reaches {share:.0%} of the rate of processes.")
    core_hours = MANY * each_ms / 3.6e6
    print(f"\n{MANY:,} runs: {core_hours:.0f} core-hours, {MANY * here.bytes_each / 1e9:.1f} GB of journals;")
    print(f"on {MACHINES} machines of {CORES} such cores {core_hours / (MACHINES * CORES) * 60:.0f} min.")


if __name__ == "__main__":
    main()
