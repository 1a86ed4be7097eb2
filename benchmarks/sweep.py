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
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from cellc.contract.compute.cluster import cluster
from cellc.contract.compute.processes import processes
from cellc.contract.compute.work import Executor, ExecutorFactory, Sent
from cellc.mock import MockCell, load
from cellc.mock.cell import cell_of
from cellc.mock.sweep.runs import GoalRoom, RunStore, SweepRun
from cellc.mock.sweep.summary import sweep_lines
from cellc.mock.sweep.sweep import sweep

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
    sweep(cell, cell.entry(rehearsal), seed=1, most=runs, factory=factory, ends=RunStore(), keep=keep)
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


@contextmanager
def invented(_: Sent, __: int) -> Iterator[Executor]:
    """Give an executor that makes up the ends of runs: what is left is what the client of a sweep takes."""

    def submit(numbers: Sequence[int]) -> Future[list[SweepRun]]:
        ended = Future[list[SweepRun]]()
        ended.set_result([made_up(number) for number in numbers])
        return ended

    yield Executor(submit, max_in_flight=8, packet=64)


GOALS = ("pick", "place")


def made_up(number: int) -> SweepRun:
    """Return an end of a run at two goals, one in a hundred of which missed."""
    off_m = (number * 2654435761 % (1 << 32)) / 2**32
    room = GoalRoom(off_m * 1e-3, 0.1 + off_m, 0.3, None, 0.02)
    passed = off_m < 0.99
    ending = "succeeded" if passed else "missed place"
    return SweepRun(number, ending, passed, dict.fromkeys(GOALS, room), 0.01, f"{number:016x}")


def client(folder: Path, rehearsal: str, runs: int) -> None:
    """Print what the client of a sweep takes, and what its summary does; start it in a process of its own."""
    cell = endless(folder)
    begun_s, begun_mb = processor_s(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    swept = sweep(
        cell, cell.entry(rehearsal), seed=1, most=runs, factory=invented, ends=RunStore(), keep=lambda _: None
    )
    gathered_s, gathered_mb = processor_s(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    lines = list(sweep_lines(swept, cell.contract, str))
    told_s, told_mb = processor_s(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{runs:,} invented runs of two goals: {len(lines)} lines of summary")
    print(
        f"gathered in {gathered_s - begun_s:.0f} s of processor time, {begun_mb:.0f} MB before, {gathered_mb:.0f} after"
    )
    print(f"summary in {told_s - gathered_s:.0f} s, at most {told_mb:.0f} MB")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default="generated/ur5e_pick")
    parser.add_argument("--rehearsal", default="pick_and_place")
    parser.add_argument("--runs", type=int, default=400)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--dask", action="store_true", help="workers of a Dask cluster too")
    parser.add_argument("--invented", type=int, metavar="RUNS", help="measure the client alone, with made-up runs")
    options = parser.parse_args()
    os.chdir(ROOT)
    if options.invented:
        client(Path(options.folder), options.rehearsal, options.invented)
        return
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
