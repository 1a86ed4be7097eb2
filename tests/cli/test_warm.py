"""Whole processes: a call whose answers are kept prints what the first one printed, byte for byte, and loads little."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

from tests.cli.refused import process
from tests.cli.run import MINIMAL, PICK, ROOT, Ran

# Errors with related places, errors in descriptions of the user's own, warnings, a clean cell, a cell that is missing.
CELLS = [
    PICK,
    "cells/minimal/cell.yaml",
    "tests/corpus/invalid/circular-mimic-of-two.yaml",
    "tests/corpus/valid/unicode_texts.yaml",
    "tests/corpus/invalid/nothing.yaml",
]
RELATED = "tests/corpus/invalid/duplicate-model-name-link.yaml"


@pytest.fixture(name="home", autouse=True)
def home_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache/cellc"


def _entries(home: Path) -> dict[str, int]:
    return {file.name: file.stat().st_mtime_ns for kind in ("check", "compile") for file in (home / kind).glob("*")}


@pytest.mark.parametrize("output_format", ["text", "json", "sarif", "github"])
def test_a_warm_check_prints_the_same_bytes(output_format: str, home: Path) -> None:
    arguments = ["check", *CELLS, RELATED, "--format", output_format]
    uncached = process(*arguments, CELLC_NO_CACHE="1", FORCE_COLOR="1")
    cold = process(*arguments, FORCE_COLOR="1")
    kept = _entries(home)
    warm = process(*arguments, FORCE_COLOR="1")
    assert uncached == cold == warm
    assert uncached.code == 1
    assert len(kept) == len(CELLS) + 1
    assert _entries(home) == kept  # recalled, not computed and kept again
    assert output_format != "text" or "note" in uncached.out


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(["check", MINIMAL], 0), (["check", RELATED], 1), (["check", MINIMAL, "--format", "json"], 0)],
    ids=["clean", "errors", "json"],
)
def test_a_warm_check_loads_no_stage_of_the_compiler(arguments: list[str], code: int) -> None:
    process(*arguments)
    assert _loaded(arguments, code) == set()


def test_a_build_that_changes_nothing_loads_no_stage_of_the_compiler(tmp_path: Path) -> None:
    arguments = ["build", MINIMAL, "-o", str(tmp_path / "out")]
    process(*arguments)
    assert _loaded(arguments, 0) == set()


def _loaded(arguments: list[str], code: int) -> set[str]:
    """Return what a process loads that it should not need."""
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "cellc", *arguments], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == code
    loaded = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "cellc.cli.main" in loaded
    heavy = {"pydantic", "numpy", "networkx", "yaml", "xacro", "multiprocessing"}
    stages = {f"cellc.{stage}" for stage in ("pipeline", "rules", "graph", "link", "spec", "source", "emit", "verify")}
    return loaded & (heavy | stages)


def test_files_of_the_package_are_not_asked_for_again(home: Path) -> None:
    process("check", PICK)
    (entry,) = (home / "check").iterdir()
    asked = json.loads(zlib.decompress(entry.read_bytes().partition(b"\n")[2]))["asked"]["marks"]
    assert {path for what, path, _, _ in asked if what == "contents"} == {PICK}


def _copied(tmp_path: Path) -> Path:
    return Path(shutil.copy(MINIMAL, tmp_path / "cell.yaml"))


def test_a_warm_build_sees_what_became_of_its_folder(tmp_path: Path) -> None:
    arguments = ["build", str(_copied(tmp_path)), "-o", str(tmp_path / "out")]
    first = process(*arguments)
    files = {file: file.read_bytes() for file in (tmp_path / "out").rglob("*") if file.is_file()}
    assert f"{len(files)} written" in first.out
    assert f"{len(files)} unchanged" in process(*arguments).out
    assert process(*arguments, "--check").code == 0

    (tmp_path / "out/minimal/README.md").unlink()
    assert process(*arguments, "--check").code == 1
    assert f"1 written, {len(files) - 1} unchanged" in process(*arguments).out

    (tmp_path / "out/minimal/README.md").write_text("mine\n")
    assert "edited-by-hand" in process(*arguments).out
    assert f"1 written, {len(files) - 1} unchanged" in process(*arguments, "--force").out

    shutil.rmtree(tmp_path / "out")
    assert f"{len(files)} written" in process(*arguments).out
    assert {file: file.read_bytes() for file in (tmp_path / "out").rglob("*") if file.is_file()} == files


def test_a_changed_cell_is_built_anew(tmp_path: Path) -> None:
    cell = _copied(tmp_path)
    process("build", str(cell), "-o", str(tmp_path / "out"))
    cell.write_text(cell.read_text().replace("goal_tolerance: 0.01 rad", "goal_tolerance: 0.02 rad"))
    process("build", str(cell), "-o", str(tmp_path / "out"))
    parameters = [file.read_text() for file in (tmp_path / "out").rglob("*controllers*.yaml")]
    assert any("goal: 0.02" in text for text in parameters)


def test_fixing_is_not_answered_from_before(tmp_path: Path) -> None:
    cell = _copied(tmp_path)
    cell.write_text(cell.read_text().replace("update_rate:", "update_rat:"))
    assert process("check", str(cell)).code == 1
    fixed = process("check", "--fix", str(cell))
    assert fixed.code == 0, fixed.out + fixed.err
    assert "update_rate: 500 Hz" in cell.read_text()
    assert process("check", str(cell)) == Ran(0, fixed.out, "")


def test_code_that_changes_answers_anew(tmp_path: Path, home: Path) -> None:
    shutil.copytree(ROOT / "cellc", tmp_path / "cellc", ignore=shutil.ignore_patterns("__pycache__"))
    arguments = ["check", MINIMAL]
    before = process(*arguments, cwd=tmp_path, PYTHONPATH=str(tmp_path))
    kept = _entries(home)
    rule = next((tmp_path / "cellc/rules").rglob("missing_rollback.py"))
    assert "missing-rollback" in before.out
    text = rule.read_text()
    rule.write_text(text.replace("yield", "return\n    yield", 1))
    after = process(*arguments, cwd=tmp_path, PYTHONPATH=str(tmp_path))
    assert "missing-rollback" not in after.out
    assert _entries(home).keys() == kept.keys()
    assert _entries(home) != kept
    rule.write_text(text)
    assert process(*arguments, cwd=tmp_path, PYTHONPATH=str(tmp_path)) == before


def test_processes_at_once_print_the_same(home: Path) -> None:
    expected = process("check", MINIMAL, CELLC_NO_CACHE="1")
    for _ in range(2):  # cold and warm
        started = [
            subprocess.Popen(
                [sys.executable, "-m", "cellc", "check", MINIMAL], cwd=ROOT, stdout=subprocess.PIPE, text=True
            )
            for _ in range(3)
        ]
        assert [child.communicate()[0] for child in started] == [expected.out] * 3
    assert len(_entries(home)) == 1
    assert not list(home.rglob("*.part"))


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the user may write everywhere")
def test_a_folder_of_the_cache_that_is_read_only_costs_time_only(home: Path) -> None:
    (home / "check").mkdir(parents=True)
    (home / "check").chmod(0o500)
    first, second = process("check", MINIMAL), process("check", MINIMAL)
    (home / "check").chmod(0o700)
    assert first == second
    assert _entries(home) == {}


def test_many_cells_are_answered_in_their_order(home: Path) -> None:
    cells = [file.as_posix() for file in sorted((ROOT / "tests/corpus/valid").glob("*.yaml"))[:36]]
    mixed = [cells[position * 7 % len(cells)] for position in range(35)]
    expected = Ran(0, "".join(f"no findings in {file}\n" for file in mixed), "")
    process("check", *mixed[:3])
    assert process("check", *mixed) == process("check", *mixed) == expected
    assert len(_entries(home)) == len(set(mixed))
