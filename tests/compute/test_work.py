"""Units are answered once each, whoever does them, and whoever dies of them."""

from __future__ import annotations

import multiprocessing
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from cellc.contract.compute import processes as of_machine
from cellc.contract.compute.processes import process_number, processes
from cellc.contract.compute.versions import difference, versions
from cellc.contract.compute.work import ComputeError, Work, in_order, stream


def _squares(offset: int) -> Callable[[int], int]:
    return lambda unit: unit * unit + offset


def _deadly(folder: str) -> Callable[[int], int]:
    """Answer; the process that gets unit 3 ends by itself as often as the folder has files to take away."""

    def do(unit: int) -> int:
        lives = sorted(Path(folder).iterdir()) if unit == 3 else []
        if lives:
            lives[0].unlink()
            os._exit(9)
        return unit * unit

    return do


def _refused(_: None) -> Callable[[int], int]:
    raise ValueError("not with this shared value")


def _endless(_: None) -> Callable[[int], int]:
    def do(unit: int) -> int:
        time.sleep(600.0 if unit else 0.0)
        return unit

    return do


def _numbered(_: None) -> Callable[[int], tuple[int, int]]:
    def do(unit: int) -> tuple[int, int]:
        time.sleep(0.02)  # so that each process takes some
        return os.getpid(), process_number()

    return do


def test_each_process_of_an_executor_has_a_number_of_its_own() -> None:
    told = {answer for _, answer in stream(Work(_numbered, None), range(60), processes(3))}
    assert len({process for process, _ in told}) == len({number for _, number in told}) == len(told)
    assert {number for _, number in told} <= {0, 1, 2}
    assert process_number() == 0


def test_every_unit_is_answered_once_and_no_process_is_left() -> None:
    found = list(stream(Work(_squares, 5), range(7), processes(2)))
    assert sorted(found) == [(number, number * number + 5) for number in range(7)]
    assert list(in_order(found)) == [number * number + 5 for number in range(7)]
    assert multiprocessing.active_children() == []


def test_a_worker_that_dies_costs_time_and_nothing_else(tmp_path: Path) -> None:
    for life in range(2):
        (tmp_path / str(life)).touch()
    found = sorted(stream(Work(_deadly, str(tmp_path)), range(6), processes(2)))
    assert found == [(number, number * number) for number in range(6)]
    assert list(tmp_path.iterdir()) == []


def test_a_unit_that_no_worker_survives_is_named(tmp_path: Path) -> None:
    for life in range(9):
        (tmp_path / str(life)).touch()
    work = Work(_deadly, str(tmp_path), lambda unit: f"unit {unit}")
    with pytest.raises(ComputeError, match=re.escape("`unit 3` ended by itself, 3 times")):
        list(stream(work, range(6), processes(2)))
    assert len(list(tmp_path.iterdir())) == 6
    assert multiprocessing.active_children() == []


def test_what_work_raises_is_raised_and_a_caller_that_stops_early_leaves_no_process() -> None:
    with pytest.raises(ValueError, match="not with this shared value"):
        list(stream(Work(_refused, None), range(3), processes(2)))
    found = stream(Work(_squares, 0), range(100), processes(1))
    next(found)
    found.close()
    assert multiprocessing.active_children() == []


_HIRES = """
from cellc.contract.compute.processes import processes
from cellc.contract.compute.work import Work, stream
from tests.compute.test_work import _endless
for answer in stream(Work(_endless, None), range(5), processes(2)):
    print("begun", flush=True)
"""


@pytest.mark.parametrize("before", ["", "import sys; sys.platform = 'other'"], ids=["by the system", "by a watch"])
def test_processes_end_with_who_hired_them_though_that_was_killed(before: str, tmp_path: Path) -> None:
    script = tmp_path / "hires.py"
    script.write_text(f"{before}\nif __name__ == '__main__':\n    exec({_HIRES!r})\n", encoding="utf-8")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    hiring = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, env=environment)
    assert hiring.stdout is not None
    assert hiring.stdout.readline() == b"begun\n"
    hiring.kill()
    # It ends as soon as nobody holds the other end any more, and every process of the crew does.
    assert hiring.communicate(timeout=20.0)[0] == b""


def test_a_process_that_was_stopped_is_killed_when_it_does_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(of_machine, "_ENDS_S", 0.5)
    found = stream(Work(_endless, None), range(5), processes(2))
    assert next(found) == (0, 0)
    for child in multiprocessing.active_children():
        assert child.pid is not None
        os.kill(child.pid, signal.SIGSTOP)
    begun = time.monotonic()
    found.close()
    assert multiprocessing.active_children() == []
    assert time.monotonic() - begun < 20.0


def test_versions_are_those_that_are_installed() -> None:
    found = versions()
    assert list(found) == ["cellc", "numpy", "pin"]
    assert (found["numpy"], found["pin"]) == (np.__version__, version("pin"))
    assert re.fullmatch(r"\S+ \([0-9a-f]{12}\)", found["cellc"])
    assert found["cellc"].startswith(version("cellc"))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, ""),
        ({"another": "1"}, ""),
        ({"numpy": "0.1"}, "numpy 0.1, here is {numpy}"),
        ({"pin": "0.2"}, "pin 0.2, here is {pin}"),
        ({"pin": "0.2", "numpy": "0.1"}, "numpy 0.1, here is {numpy}"),  # the first of both
    ],
)
def test_first_difference_is_said(changes: dict[str, str], said: str) -> None:
    assert difference({**versions(), **changes}) == said.format_map(versions())


def test_what_is_not_told_is_unknown() -> None:
    there = {name: one for name, one in versions().items() if name != "numpy"}
    assert difference(there) == f"numpy UNKNOWN, here is {np.__version__}"
