"""Sweeps on a Dask cluster whose workers and scheduler are killed, and compares the journal with that of this machine.

``python -m benchmarks.sweep_killed [--runs 100000] [--compared 10000] [--each 60]``. An arm moves to a goal; its
repeatability is drawn, and no success rate is expected, so that no verdict ends the sweep early. About every
``--each`` seconds, at moments drawn with a fixed seed, one of two workers is killed, or, every fifth time, the
scheduler with both; what was killed is started again. ``cellc sweep --cluster --journal`` is called again until it has
done all runs, as a user would. The first ``--compared`` runs are done again without a cluster, in a new journal: both
must hold the same lines.
"""

from __future__ import annotations

import argparse
import json
import random
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

LOOPBACK = "127.0.0.1"
WORKERS = 2
CELL = """
format: 1
cell: killed
versions: {ros: jazzy}
devices:
  arm: {model: ur5e}
control:
  update_rate: 500 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
    arm_trajectory: {type: scaled_joint_trajectory, device: arm, goal_time: 1 s, path_tolerance: 0.2 rad,
                     goal_tolerance: 0.01 rad}
motion:
  groups: {manipulator: {base: arm/base_link, tip: arm/tool0}}
  poses: {ready: {manipulator: 0 -90 90 -90 -90 0 deg}}
  goals:
    over: {group: manipulator, frame: arm/base_link, xyz: 0.4 0.2 0.3 m, rpy: 180 0 0 deg, approach: 0 0 -100 mm}
rehearsals:
  there: {steps: [{move: over}]}
uncertainty: {repeatability: {arm: 0.1 mm}}
"""
OF_SCHEDULER = 5
"""One kill in how many is that of the scheduler."""


class Killed:
    """A scheduler and its workers, each a process that can be killed and is started again."""

    def __init__(self) -> None:
        with socket.socket() as free:
            free.bind((LOOPBACK, 0))
            self._port = str(free.getsockname()[1])
        self.address = f"tcp://{LOOPBACK}:{self._port}"
        self.kills = {"worker": 0, "scheduler": 0}
        self._start()

    def _start(self) -> None:
        self._scheduler = _dask("scheduler", "--host", LOOPBACK, "--port", self._port)
        self._workers = [self._worker() for _ in range(WORKERS)]

    def _worker(self) -> subprocess.Popen[bytes]:
        return _dask("worker", self.address, "--nthreads", "1", "--no-nanny")

    def kill_worker(self, which: int) -> None:
        """Kill a worker and start another in its place."""
        self.kills["worker"] += 1
        _kill(self._workers[which])
        self._workers[which] = self._worker()

    def kill_scheduler(self) -> None:
        """Kill the scheduler and all workers, and start them again at the same address."""
        self.kills["scheduler"] += 1
        self.end()
        self._start()

    def end(self) -> None:
        """Kill everything."""
        for program in (self._scheduler, *self._workers):
            _kill(program)


def _dask(*words: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "dask", *words, "--no-dashboard"]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _kill(program: subprocess.Popen[bytes]) -> None:
    program.kill()
    program.wait()


def built(place: Path) -> Path:
    """Build the cell below a folder, and return its package."""
    spec, packages = place / "cell.yaml", place / "generated"
    spec.write_text(CELL, encoding="utf-8")
    words = [sys.executable, "-m", "cellc", "build", str(spec), "-o", str(packages)]
    subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    return packages / "killed"


def command(folder: Path, runs: int, journal: Path) -> list[str]:
    """Return the command of a sweep."""
    return [sys.executable, "-m", "cellc", "sweep", str(folder), "--runs", str(runs), "--journal", str(journal)]


def swept(asked: Sequence[str], cluster: Killed, each_s: float) -> tuple[int, set[str]]:
    """Call a sweep until it is done while its cluster is killed; return how often, and what its calls said."""
    drawn, calls, said = random.Random(1), 0, set[str]()
    while True:
        calls += 1
        sweep = subprocess.Popen([*asked, "--cluster", cluster.address], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while True:
            try:
                _, errors = sweep.communicate(timeout=drawn.uniform(0.5, 1.5) * each_s)
                break
            except subprocess.TimeoutExpired:
                if drawn.randrange(OF_SCHEDULER):
                    cluster.kill_worker(drawn.randrange(WORKERS))
                else:
                    cluster.kill_scheduler()
        lines = errors.decode().splitlines()
        if not lines or not lines[-1].startswith("error:"):
            return calls, said
        said.add(lines[-1].replace(cluster.address, "ADDRESS"))


def lines_of(journal: Path, most: int) -> list[str]:
    """Return the first runs of a journal, in the order of their numbers."""
    with journal.open(encoding="utf-8") as text:
        next(text)
        numbered = ((json.loads(line)["number"], line) for line in text)
        return [line for _, line in sorted(pair for pair in numbered if pair[0] < most)]


def main() -> None:
    """Print what was killed and whether the journals agree; exit 1 where they do not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("--compared", type=int, default=10_000)
    parser.add_argument("--each", type=float, default=60.0, metavar="SECONDS")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        place = Path(temporary)
        folder = built(place)
        there, here = place / "cluster.jsonl", place / "here.jsonl"
        cluster, begun_s = Killed(), time.perf_counter()
        try:
            asked = command(folder, options.runs, there)
            calls, said = swept(asked, cluster, options.each)
        finally:
            cluster.end()
        took_s = time.perf_counter() - begun_s
        subprocess.run(command(folder, options.compared, here), stdout=subprocess.DEVNULL)
        runs, bytes_of = len(lines_of(there, options.runs)), there.stat().st_size
        same = lines_of(there, options.compared) == lines_of(here, options.compared)
    print(f"{runs:,} runs in {calls} calls and {took_s:.0f} s, {bytes_of / 1e6:.0f} MB of journal")
    print(f"killed: {cluster.kills['worker']} workers, {cluster.kills['scheduler']} schedulers with their workers")
    print("\n".join(sorted(said)))
    print(f"the first {options.compared:,} are {'the same' if same else 'NOT the same'} as without a cluster")
    raise SystemExit(0 if same and runs == options.runs else 1)


if __name__ == "__main__":
    main()
