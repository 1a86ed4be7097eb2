"""A real scheduler of Dask with two workers, each a process of its own, on the loopback interface."""

from __future__ import annotations

import re
import socket
import socketserver
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

import pytest

from cellc.contract.compute import cluster as of_dask
from cellc.contract.compute.cluster import cluster
from cellc.contract.compute.fan import Fan
from cellc.contract.compute.versions import versions
from cellc.contract.compute.work import ComputeError, Work, stream
from cellc.mock import load
from cellc.mock.campaign.campaign import conduct, make_plan
from cellc.mock.faults.registry import possible_faults
from cellc.tools.cli.batch import results
from cellc.tools.cli.fleet import Task
from tests.cells import ROOT, written
from tests.cli.refused import process
from tests.compute.test_work import _deadly, _squares

LOOPBACK = "127.0.0.1"


class Dask:
    """The programs of a cluster, by their own commands."""

    def __init__(self, folder: Path, workers: int = 2) -> None:
        with socket.socket() as free:
            free.bind((LOOPBACK, 0))
            self.address = f"tcp://{LOOPBACK}:{free.getsockname()[1]}"
        self._folder = folder
        self.scheduler = self._start(
            "scheduler", "--host", LOOPBACK, "--port", self.address.rpartition(":")[2], "--no-dashboard"
        )
        self.workers = [
            self._start("worker", self.address, "--nthreads", "1", "--no-dashboard", "--no-nanny")
            for _ in range(workers)
        ]

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        with (self._folder / f"{len(list(self._folder.iterdir()))}.log").open("wb") as log:
            command = [sys.executable, "-m", "dask", *words]
            return subprocess.Popen(command, cwd=self._folder, stdout=log, stderr=log)

    def end(self) -> None:
        for program in (*self.workers, self.scheduler):
            program.terminate()
        for program in (*self.workers, self.scheduler):
            program.wait()


@pytest.fixture(autouse=True)
def _of_any_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a busy machine take its time to start the programs."""
    monkeypatch.setattr(of_dask, "_CONNECTS_S", 600.0)


@pytest.fixture(scope="module")
def dask(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Dask]:
    started = Dask(tmp_path_factory.mktemp("dask"))
    yield started
    started.end()


def _slow(_: None) -> Callable[[int], int]:
    def do(unit: int) -> int:
        time.sleep(0.05)
        return -unit

    return do


def test_a_campaign_is_the_same_on_a_cluster_as_here(dask: Dask) -> None:
    cell = load(ROOT / "generated" / "minimal")
    plan, baselines = make_plan(cell, possible_faults(cell.contract), 0)
    runs = tuple(plan.singles())[::15]
    here, there = (
        conduct(cell, runs, baselines, seed=0, factory=factory, progress=lambda *_: None)
        for factory in (None, cluster(dask.address))
    )
    assert there.ends == here.ends
    # A type of numpy in one of the two compares as equal; what is written shows it.
    assert repr([asdict(end) for end in there.ends]) == repr([asdict(end) for end in here.ends])
    assert len(there.ends) > 20


def test_cells_are_checked_on_a_cluster_as_they_are_here(dask: Dask, tmp_path: Path) -> None:
    spec = written(
        tmp_path, "format: 1\ncell: camera\nversions: {ros: jazzy}\ndevices: {eye: {model: realsense_d435i}}\n"
    )
    tasks = [Task(spec.as_posix(), {"ros": distro}) for distro in ("humble", "kilted")]
    here, there = (list(results("check", tasks, Fan(cluster=address))) for address in (None, dask.address))
    assert there == here
    assert all(one.cell is not None for one in there)


def test_a_worker_of_a_cluster_that_dies_costs_time_alone(dask: Dask, tmp_path: Path) -> None:
    (tmp_path / "life").touch()
    found = sorted(stream(Work(_deadly, str(tmp_path)), range(12), cluster(dask.address)))
    assert found == [(number, number * number) for number in range(12)]
    assert list(tmp_path.iterdir()) == []


def test_a_scheduler_without_workers_is_told_and_not_waited_for_without_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(of_dask, "_IDLE_S", 2.0)
    monkeypatch.setattr(of_dask, "_ASK_S", 0.2)
    told: list[str] = []
    alone = Dask(tmp_path, workers=1)
    try:
        answers = stream(Work(_slow, None), range(100_000), cluster(alone.address, told.append))
        next(answers)
        assert told == []
        alone.workers[0].kill()
        with pytest.raises(ComputeError, match=rf"^the scheduler at `{alone.address}` has had no worker for 2 s$"):
            list(answers)
    finally:
        alone.end()
    (line,) = told
    assert line.startswith(
        f"the scheduler at `{alone.address}` has no worker; one is waited for, at most 2 s. Start it"
    )


def test_a_worker_with_other_versions_is_refused(dask: Dask, monkeypatch: pytest.MonkeyPatch) -> None:
    there = dict(versions())
    monkeypatch.setattr(of_dask, "versions", lambda: there | {"numpy": "1.0.0"})
    with pytest.raises(ComputeError, match=rf"a worker has numpy {there['numpy']}, here is 1\.0\.0; both must be"):
        list(stream(Work(_squares, 5), range(3), cluster(dask.address)))


def test_a_scheduler_that_goes_ends_the_call_in_one_line(dask: Dask) -> None:
    answers = stream(Work(_slow, None), range(100_000), cluster(dask.address))
    first = next(answers)
    assert first[1] == -first[0]
    dask.scheduler.kill()
    with pytest.raises(ComputeError, match=rf"^the scheduler at `{dask.address}` has gone$"):
        list(answers)


def test_no_scheduler_at_all_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(of_dask, "_CONNECTS_S", 0.5)
    with pytest.raises(ComputeError, match=r"no scheduler of Dask answers at `tcp://127\.0\.0\.1:9`"):
        list(stream(Work(_squares, 5), range(3), cluster("tcp://127.0.0.1:9")))


@pytest.mark.parametrize("address", ["foo", "", "http://127.0.0.1:8786", "inproc://x", "tcp://127.0.0.1", "tcp://x:y"])
def test_what_is_no_address_is_told_at_once(address: str) -> None:
    with pytest.raises(
        ComputeError, match=rf"^`{re.escape(address)}` is not the address of a scheduler; write one such"
    ):
        list(stream(Work(_squares, 5), range(3), cluster(address)))


def test_what_is_no_scheduler_is_told_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(of_dask, "_CONNECTS_S", 1.0)
    with socketserver.TCPServer((LOOPBACK, 0), socketserver.BaseRequestHandler) as other:
        threading.Thread(target=other.serve_forever, daemon=True).start()
        address = f"tcp://{LOOPBACK}:{other.server_address[1]}"
        with pytest.raises(ComputeError, match=rf"^no scheduler of Dask answers at `{address}`$"):
            list(stream(Work(_squares, 5), range(3), cluster(address)))
        other.shutdown()


def test_nothing_of_a_wrong_address_is_told_beside_the_one_line() -> None:
    ran = process("campaign", "generated/minimal", "--cluster", f"tls://{LOOPBACK}:9")
    assert ran.code == 2
    assert ran.err == f"error: `tls://{LOOPBACK}:9` needs TLS, of which the configuration of Dask says nothing\n"
