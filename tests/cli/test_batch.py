"""Several processes answer as one does, in the order of the call."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from cellc.contract import limits
from cellc.contract.compute.processes import processes
from cellc.tools.cli import batch
from cellc.tools.cli.batch import CellResult, cell_files, compute, in_workers, number_of_workers
from cellc.tools.cli.fleet import Task
from tests.cells import ROOT
from tests.cli.run import MINIMAL, run

FILES = [Task(file.as_posix()) for file in sorted((ROOT / "tests/corpus/invalid").glob("un*.yaml"))[:3]]
SMALL = Task(MINIMAL)


def test_workers_answer_as_this_process_does() -> None:
    assert list(in_workers("check", FILES, processes(2))) == [compute("check", file) for file in FILES]
    assert multiprocessing.active_children() == []


def test_workers_compile_as_this_process_does() -> None:
    assert list(in_workers("compile", [SMALL, FILES[0]], processes(2))) == [
        compute("compile", SMALL),
        compute("compile", FILES[0]),
    ]


def test_a_caller_that_stops_early_leaves_no_process() -> None:
    found = in_workers("check", FILES, processes(2))
    assert next(found) == compute("check", FILES[0])
    found.close()
    assert multiprocessing.active_children() == []


@pytest.mark.parametrize(
    ("cells", "cores", "number"),
    [(1, 8, 1), (31, 8, 1), (32, 8, 2), (100, 1, 1), (100, 2, 2), (100, 64, 6), (10_000, 64, 8), (0, 2, 1)],
)
def test_as_many_processes_check_as_pay(cells: int, cores: int, number: int) -> None:
    assert number_of_workers("check", cells, cores) == number


def test_a_few_cells_that_are_compiled_pay() -> None:
    assert [number_of_workers("compile", cells, 2) for cells in (1, 5, 6)] == [1, 1, 2]


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="the system cannot bind a process to cores")
def test_a_process_bound_to_one_core_starts_no_others() -> None:
    allowed = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {min(allowed)})
        assert number_of_workers("check", 1000) == 1
    finally:
        os.sched_setaffinity(0, allowed)


def test_what_a_lost_process_owes_is_computed_by_another(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "fatal").touch()
    monkeypatch.setattr(batch, "_compute_within", partial(_computed_by_mortals, tmp_path.as_posix()))
    files = [SMALL, *FILES[:2]]
    assert list(in_workers("check", files, processes(2))) == [compute("check", file) for file in files]
    assert list(tmp_path.iterdir()) == []


def _computed_by_mortals(folder: str, _asked: object) -> Callable[[batch._Unit], CellResult]:
    for fatal in Path(folder).iterdir():
        fatal.unlink()
        os._exit(9)
    return lambda unit: compute("check", unit.task)


def test_folder_stands_for_every_spec_below_it(tmp_path: Path) -> None:
    for place in ("b", "a/deep", ".hidden", "env", "generated/x"):
        (tmp_path / place).mkdir(parents=True)
        (tmp_path / place / "cell.yaml").write_text("format: 1\n", encoding="utf-8")
    (tmp_path / "env" / "pyvenv.cfg").write_text("", encoding="utf-8")
    (tmp_path / "generated" / "x" / "cell.yaml").unlink()
    (tmp_path / "linked").symlink_to(tmp_path / "a")
    found = [Path(file).relative_to(tmp_path).as_posix() for file in cell_files([tmp_path.as_posix()])]
    assert found == ["a/deep/cell.yaml", "b/cell.yaml"]


def test_folder_without_a_spec_is_told_as_what_it_is(tmp_path: Path) -> None:
    ran = run("check", tmp_path.as_posix())
    assert ran.code == 1
    assert "is a folder" in ran.out


@pytest.mark.parametrize(("command", "jobs"), [("check", "1"), ("check", "2"), ("build", "1")])
def test_no_spec_is_begun_after_those_before_it_took_the_time_of_a_call(
    command: str, jobs: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "DEFAULTS", replace(limits.DEFAULTS, command_seconds=0))
    text = Path(MINIMAL).read_text(encoding="utf-8")
    for name in ("first", "second", "third"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "cell.yaml").write_text(text.replace("cell: minimal", f"cell: {name}"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    done = run(command, ".", "--jobs", jobs)
    assert done.code == 1
    told = [line for line in done.out.splitlines() if line.startswith("error[command-too-long]")]
    assert len(told) == 2
    assert "first/cell.yaml:1:1" not in done.out
    assert "third/cell.yaml:1" in done.out
    assert "`--limit command-seconds=N` raises it" in done.out
    assert [folder.name for folder in tmp_path.glob("generated/*")] == (["first"] if command == "build" else [])
    assert multiprocessing.active_children() == []
