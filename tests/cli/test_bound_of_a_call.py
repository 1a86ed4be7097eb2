"""What takes the processor time of a call by itself is ended: a spec, a page, a rehearsal, and folders together."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract import limits
from cellc.contract.signals import within
from tests.cells import ROOT
from tests.cli.run import MINIMAL, run

FOLDER = ROOT / "generated/minimal"


def _endless(*_given: object, **_named: object) -> object:
    """Go on for ever, though an exception is caught on the way."""
    with suppress(Exception):
        while True:
            pass
    return _endless()


@pytest.fixture(autouse=True)
def one_second(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "DEFAULTS", replace(limits.DEFAULTS, command_seconds=1, rehearsal_seconds=1))
    monkeypatch.setattr(limits, "_in_force", limits.DEFAULTS)


@pytest.mark.parametrize("command", ["check {} --format json --jobs 1", "build {} -o out --format json --jobs 1"])
def test_a_spec_alone_ends_with_a_finding(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(MINIMAL, "cell.yaml")
    monkeypatch.setattr("cellc.compiler.pipeline.run_rules", _endless)
    ran = run(*command.format("cell.yaml").split())
    (told,) = json.loads(ran.out)["diagnostics"]
    assert (ran.code, told["code"]) == (1, "command-too-long")
    assert told["message"] == "a spec alone must take at most 1 s of processor time"
    assert not Path("out").exists()


@pytest.mark.parametrize("endless", ["cellc.tools.view.content.scene_of", "cellc.compiler.pipeline.run_rules"])
def test_a_page_ends_in_one_line(endless: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(endless, _endless)
    ran = run("view", MINIMAL, "-o", (tmp_path / "page.html").as_posix())
    reason = "must take at most 1 s of processor time; `--limit command-seconds=N` raises it"
    assert (ran.code, ran.err) == (2, f"error: {MINIMAL}: {reason}\n")
    assert list(tmp_path.iterdir()) == []


def test_a_rehearsal_alone_ends_as_one_that_reached_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cellc.mock.cell.Bringup", _endless)
    ran = run("mock", FOLDER.as_posix(), "--rehearsal", "ready", "--json")
    (told,) = json.loads(ran.out)["rehearsals"]
    assert (ran.code, told["outcome"]) == (1, "limit_reached")
    assert "a rehearsal must take at most 1 s of processor time" in told["reason"]


def test_no_folder_is_begun_after_those_before_it_took_the_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in "abc":
        shutil.copytree(FOLDER, tmp_path / name)
    clock = iter(range(0, 1000, 2))  # each folder takes two seconds by it
    monkeypatch.setattr("cellc.mock.command.fleet.process_time", lambda: float(next(clock)))
    ran = run("mock", tmp_path.as_posix(), "--jobs", "1", "--json")
    problems = [row["problem"] for row in json.loads(ran.out)["rows"]]
    cut = "the rehearsals of all folders must take at most 1 s of processor time together"
    assert ran.code == 1
    assert problems[0] == ""
    assert [problem.partition(";")[0] for problem in problems[1:]] == [cut, cut]


def _spin(seconds: float) -> str:
    until = time.process_time() + seconds
    while time.process_time() < until:
        pass
    return "done"


def test_an_inner_bound_leaves_the_outer_as_it_was() -> None:
    seen: list[object] = []

    def outer() -> Sequence[object]:
        seen.append(within(0.05, lambda: _endless()))
        seen.append(within(100, lambda: _spin(0.05)))
        _endless()
        return seen

    assert within(0.5, outer) is None
    assert seen == [None, "done"]


def test_work_within_its_time_is_as_it_was() -> None:
    assert within(60, lambda: _spin(0.01)) == "done"
    assert within(0, lambda: _spin(0.01)) == "done"
