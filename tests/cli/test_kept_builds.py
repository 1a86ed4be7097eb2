"""A build of what is unchanged is not computed again, and whatever is changed is."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.contract.vocabulary import Distro
from cellc.tools.cli import batch
from cellc.tools.cli.fleet import Task
from tests.cells import ROOT
from tests.cli.run import Ran, run

_LIFT = ROOT / "tests/corpus/valid/parts/lift"


@pytest.fixture(name="cell", autouse=True)
def cell_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cell in the current folder, last changed long enough ago, with a cache and a key of its own."""
    (tmp_path / "work").mkdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.delenv("CELLC_NO_CACHE", raising=False)
    monkeypatch.chdir(tmp_path / "work")
    shutil.copytree(ROOT / "cells/minimal", "cell")
    time.sleep(0.2)
    return Path("cell/cell.yaml")


@pytest.fixture(name="computed")
def computed_fixture(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The specs that were compiled, one entry for each time."""
    compiled: list[str] = []
    compute = batch.compute

    def counting(kind: batch.Kind, task: Task) -> batch.CellResult:
        compiled.append(task.file)
        return compute(kind, task)

    monkeypatch.setattr(batch, "compute", counting)
    return compiled


def _build(cell: Path, *options: str) -> Ran:
    return run("build", str(cell), *options)


def test_what_is_unchanged_is_computed_once_and_told_the_same(cell: Path, computed: list[str]) -> None:
    _build(cell)
    anew = _build(cell, "--check", "--full")
    again = _build(cell, "--check")
    assert len(computed) == 2
    assert (again.code, again.out) == (0, anew.out)
    as_json = [_build(cell, "--check", "--json", *full).out for full in ((), ("--full",))]
    assert len(computed) == 3
    assert as_json[0] == as_json[1]


def test_folder_is_compared_and_written_as_if_it_were_computed(cell: Path, computed: list[str]) -> None:
    _build(cell)
    readme = next(Path("generated").rglob("README.md"))
    text = readme.read_text(encoding="utf-8")
    readme.write_text(text + "by hand\n", encoding="utf-8")
    differs = _build(cell, "--check")
    assert (differs.code, "by hand" in differs.out) == (1, True)
    readme.unlink()
    assert _build(cell).code == 0
    assert readme.read_text(encoding="utf-8") == text
    assert len(computed) == 1


def _edit(cell: Path) -> None:
    cell.write_text(cell.read_text(encoding="utf-8") + "# more\n", encoding="utf-8")


def _edit_at_the_same_time_and_size(cell: Path) -> None:
    state, text = cell.stat(), cell.read_text(encoding="utf-8")
    cell.write_text(text.replace("minimal", "maximal", 1), encoding="utf-8")
    os.utime(cell, ns=(state.st_atime_ns, state.st_mtime_ns))


def _add_a_device(cell: Path) -> None:
    shutil.copytree(_LIFT, cell.parent / "ur5e")


def _begin_a_repository(cell: Path) -> None:
    (cell.parents[1] / ".git").mkdir()


def _begin_a_package(cell: Path) -> None:
    (cell.parents[1] / "package.xml").write_text("<package/>", encoding="utf-8")


def _put_a_link(cell: Path) -> None:
    (cell.parent / "more").symlink_to(_LIFT, target_is_directory=True)


@pytest.mark.parametrize(
    "change",
    [
        _edit,
        _edit_at_the_same_time_and_size,
        _add_a_device,
        _begin_a_repository,
        _begin_a_package,
        _put_a_link,
    ],
)
def test_change_is_computed(cell: Path, computed: list[str], change: Callable[[Path], None]) -> None:
    _build(cell)
    change(cell)
    _build(cell, "--check")
    assert len(computed) == 2


@pytest.mark.parametrize(
    "options",
    [("--limit", "spec-files=40"), ("--matrix", f"ros={Distro.JAZZY.value}")],
    ids=["other limits", "other versions"],
)
def test_other_question_is_computed(cell: Path, computed: list[str], options: tuple[str, ...]) -> None:
    _build(cell)
    _build(cell, "--check", *options)
    assert len(computed) == 2


def test_entry_of_others_is_not_read(cell: Path, computed: list[str], tmp_path: Path) -> None:
    _build(cell)
    (entry,) = (tmp_path / "cache/cellc/build").iterdir()
    kept = entry.read_bytes()
    entry.write_bytes(kept[:-1] + bytes([kept[-1] ^ 1]))
    _build(cell, "--check")
    shutil.rmtree(tmp_path / "state")
    assert len(computed) == 2


def test_what_was_changed_while_it_was_built_is_not_kept(
    cell: Path, computed: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    compute = batch.compute

    def changing(kind: batch.Kind, task: Task) -> batch.CellResult:
        os.utime(cell)  # its status changes now
        return compute(kind, task)

    with monkeypatch.context() as while_built:
        while_built.setattr(batch, "compute", changing)
        _build(cell)
    _build(cell, "--check")
    assert len(computed) == 2


def test_cell_with_an_error_is_not_kept(cell: Path, computed: list[str]) -> None:
    cell.write_text(cell.read_text(encoding="utf-8") + "nonsense: 1\n", encoding="utf-8")
    time.sleep(0.2)
    codes = [_build(cell).code, _build(cell).code]
    assert codes == [1, 1]
    assert len(computed) == 2


def test_what_is_unchanged_loads_no_compiler(cell: Path) -> None:
    code = (
        "import sys; sys.argv[1:] = ['build', '--check', 'cell/cell.yaml']\n"
        "from cellc.tools.cli.main import run\n"
        "assert run() == 0\n"
        "print({'yaml', 'networkx', 'numpy', 'cellc.compiler.pipeline'} & set(sys.modules))\n"
    )
    loaded = ""
    for _ in range(3):  # an answer that rests on what a busy machine had left is not kept, and the next one may be
        _build(cell)
        ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        loaded = ran.stdout.splitlines()[-1]
        if loaded == "set()":
            break
    assert loaded == "set()"
