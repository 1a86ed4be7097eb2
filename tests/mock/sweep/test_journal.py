"""A journal takes over no file of another kind, and counts no line that is not a run of its sweep."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import pytest

from cellc.contract.compute.versions import versions
from cellc.mock import MockCell, MockError, load
from cellc.mock.sweep import journal as of_runs
from cellc.mock.sweep.journal import Journal
from cellc.mock.sweep.runs import GoalRoom, SweepRun
from tests.cells import ROOT
from tests.cli.run import run

RUN = SweepRun(0, "succeeded", True, {"put": GoalRoom(0.001, 0.1, 0.4, None, None)}, 0.01, "0123456789abcdef")


@pytest.fixture
def file(nest: MockCell, tmp_path: Path) -> Path:
    """Return a journal with one run."""
    with Journal(tmp_path / "runs.jsonl", nest.contract, "put", 0) as journal:
        journal.keep(RUN)
    return tmp_path / "runs.jsonl"


@pytest.mark.parametrize("line", [1, 2])
def test_a_journal_of_any_size_is_refused_at_its_first_long_line(line: int, nest_folder: Path, tmp_path: Path) -> None:
    mine = tmp_path / "runs.jsonl"
    if line == 2:
        with Journal(mine, load(nest_folder).contract, "put", 0):
            pass
    with mine.open("ab") as file:
        file.truncate(8 << 30)
    ran = run("sweep", str(nest_folder), "--runs", "3", "--jobs", "1", "--journal", str(mine))
    assert (ran.code, f"line {line} has more than 1048576 bytes" in ran.err) == (2, True), ran
    assert mine.stat().st_size == 8 << 30


@pytest.mark.parametrize("notes", [b"my notes, one line", b"mine\n", b"{}", b"[]\n", b'{"journal":7}\n'])
def test_a_file_that_is_no_journal_is_left_as_it_is(notes: bytes, nest_folder: Path, tmp_path: Path) -> None:
    mine = tmp_path / "notes.txt"
    mine.write_bytes(notes)
    for command, *asked in (["sweep", "--runs", "3", "--jobs", "1"], ["replay", "sweep:1"]):
        ran = run(command, str(nest_folder), *asked, "--journal", str(mine))
        assert (ran.code, "is not a journal" in ran.err) == (2, True), ran
        assert mine.read_bytes() == notes


def test_an_empty_file_and_a_head_that_was_cut_off_become_a_journal(nest: MockCell, file: Path) -> None:
    whole = file.read_bytes()
    for end in (0, 1, 40, whole.index(b"\n")):
        file.write_bytes(whole[:end])
        with Journal(file, nest.contract, "put", 0) as journal:
            assert journal.runs == {}
            journal.keep(RUN)
        assert file.read_bytes() == whole


def test_runs_that_another_program_made_are_not_mixed_with_those_of_this_one(
    nest: MockCell, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = versions()
    monkeypatch.setattr("cellc.contract.compute.versions.versions", lambda: {**here, "numpy": "1.0.0"})
    with pytest.raises(MockError, match=rf"has runs that were made with numpy {here['numpy']}, here is 1\.0\.0; name"):
        Journal(file, nest.contract, "put", 0)
    head, _, runs = file.read_text(encoding="utf-8").partition("\n")
    file.write_text(head.replace(of_runs._FORMAT, "cellc sweep 2") + "\n" + runs, encoding="utf-8")
    with pytest.raises(MockError, match="was written by another version of cellc; name another file"):
        Journal(file, nest.contract, "put", 0)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"passed": "no"}, "line 3 is not a run: `passed`: input should be a valid boolean"),
        ({"number": True}, "line 3 is not a run: `number`: input should be a valid integer"),
        ({"number": -1}, "line 3 is not a run: `number`: input should be greater than or equal to 0"),
        ({"number": 10**18}, "line 3 is not a run: `number`: input should be less than"),
        ({"digest": None}, "line 3 is not a run: `digest`: input should be a valid string"),
        (
            {"goals": {"put": {"distance_m": "z"}}},
            "line 3 is not a run: `goals.put.distance_m`: input should be a valid n",
        ),
        ({"goals": {"pot": asdict(RUN)["goals"]["put"]}}, "line 3 is not a run of this cell: there is no goal `pot`"),
        (
            {"joint_state_age_s": float("nan")},
            "line 3 is not a run: `joint_state_age_s`: input should be a finite number",
        ),
        ({"more": 1}, "line 3 is not a run: `more`: extra inputs are not permitted"),
        ({"number": 0, "passed": False}, "line 3 contradicts another line of run 0"),
    ],
)
def test_a_line_that_is_no_run_is_told_with_its_number(
    change: Mapping[str, object], words: str, nest: MockCell, file: Path
) -> None:
    with file.open("a", encoding="utf-8") as damaged:
        damaged.write(json.dumps({**asdict(RUN), "number": 1, **change}) + "\n")
    with pytest.raises(MockError) as told:
        Journal(file, nest.contract, "put", 0)
    assert words in str(told.value)


@pytest.mark.parametrize("line", ["null", "7", "[]", "x", '"run"', "[" * 100_000])
def test_a_line_that_is_no_object_is_told_too(line: str, nest: MockCell, file: Path) -> None:
    with file.open("a", encoding="utf-8") as damaged:
        damaged.write(line + "\n")
    with pytest.raises(MockError, match="line 3 is not a run: "):
        Journal(file, nest.contract, "put", 0)


def test_a_line_that_stands_there_twice_counts_once(nest: MockCell, file: Path) -> None:
    with Journal(file, nest.contract, "put", 0) as journal:
        journal.keep(RUN)
    assert Journal(file, nest.contract, "put", 0).runs == {0: RUN}


@pytest.mark.parametrize("most_bytes", [100, 8192])
def test_a_full_disk_is_told_with_the_file_and_the_sweep_goes_on_later(
    most_bytes: int, nest_folder: Path, tmp_path: Path
) -> None:
    import resource

    journal = tmp_path / "runs.jsonl"
    asked = ["sweep", str(nest_folder), "--runs", "60", "--jobs", "1", "--journal", str(journal)]
    ended = subprocess.run(
        [sys.executable, "-m", "cellc", *asked],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes)),
        cwd=ROOT,
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (ended.returncode, ended.stderr) == (2, f"error: {journal.as_posix()}: cannot be written: file too large\n")
    assert run("sweep", str(nest_folder), "--runs", "3", "--jobs", "1", "--journal", str(journal)).code == 1
