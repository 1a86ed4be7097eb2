"""Every edit of a generated folder by hand is refused; with `--edited` it is executed, ends the run, or is told."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.manifest import Manifest
from cellc.contract.rehearsals import FaultEntry
from cellc.mock import MockCell, MockError, load
from cellc.mock.agreement.agreement import EXECUTED, kind_of, refuse_disagreement
from cellc.mock.folder import differences, read_folder
from cellc.mock.result import RehearsalResult
from tests.cells import CELLS, ROOT
from tests.mock.edits import BEGIN, EDITS, END, PAGE, Edit, table

PLAIN = ROOT / "generated" / "ur5e_pick"
RUN = [edit for edit in EDITS if edit.runs]
ENDED = [edit for edit in EDITS if edit.ends]
NOT_SHOWN = [edit for edit in EDITS if edit.not_shown]


@pytest.fixture(scope="module")
def spoilt(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the folder, whose edited files each test puts back."""
    return Path(shutil.copytree(PLAIN, tmp_path_factory.mktemp("edits") / "ur5e_pick"))


@pytest.fixture(scope="module")
def plain() -> MockCell:
    """The folder as it was generated."""
    return load(PLAIN)


@contextmanager
def _edited(folder: Path, *edits: Edit) -> Iterator[None]:
    try:
        for edit in edits:
            text = (folder / edit.file).read_text(encoding="utf-8")
            assert edit.before in text
            assert edit.after != edit.before
            (folder / edit.file).write_text(text.replace(edit.before, edit.after, 1), encoding="utf-8")
        yield
    finally:
        for edit in edits:
            shutil.copy(PLAIN / edit.file, folder / edit.file)


def _run(cell: MockCell, edit: Edit) -> RehearsalResult:
    """Run a rehearsal, and leave out what every edited folder has in its results."""
    entry = cell.entry(edit.runs)
    if edit.stuck:
        stuck = FaultEntry.model_validate({"kind": "stick", "target": edit.stuck, "at_s": 0.1})
        entry = entry.model_copy(update={"faults": (stuck,)})
    result = cell.rehearse(entry)
    return replace(result, edited=False, attempts=tuple(replace(one, configuration_id="") for one in result.attempts))


@pytest.fixture(scope="module")
def as_generated(plain: MockCell) -> Callable[[Edit], RehearsalResult]:
    """How a rehearsal ends in the folder as it was generated; each is run once."""
    known: dict[tuple[str, str], RehearsalResult] = {}

    def ended(edit: Edit) -> RehearsalResult:
        if (edit.runs, edit.stuck) not in known:
            known[edit.runs, edit.stuck] = _run(plain, edit)
        return known[edit.runs, edit.stuck]

    return ended


def test_every_edit_is_refused_with_its_file(spoilt: Path, plain: MockCell) -> None:
    manifest = Manifest.model_validate_json((spoilt / "manifest.json").read_text(encoding="utf-8"))
    for file in dict.fromkeys(edit.file for edit in EDITS):
        with _edited(spoilt, *(edit for edit in EDITS if edit.file == file)):
            assert differences(spoilt, plain.contract, manifest)[1] == (file,)
    with _edited(spoilt, EDITS[0]), pytest.raises(MockError, match="differs from the manifest"):
        load(spoilt)


@pytest.mark.parametrize("edit", RUN, ids=lambda edit: f"{edit.file}: {edit.what}")
def test_edit_of_what_is_executed_ends_otherwise(
    edit: Edit, spoilt: Path, as_generated: Callable[[Edit], RehearsalResult]
) -> None:
    with _edited(spoilt, edit):
        result = _run(load(spoilt, edited=True), edit)
    assert result.outcome == edit.outcome
    assert result != as_generated(edit)


@pytest.mark.parametrize("edit", ENDED, ids=lambda edit: f"{edit.file}: {edit.what}")
def test_edit_of_what_is_told_again_ends_the_run(edit: Edit, spoilt: Path, plain: MockCell) -> None:
    of_its_own = kind_of(edit.file, plain.contract.files) not in EXECUTED
    with _edited(spoilt, edit), pytest.raises(MockError) as caught:
        refuse_disagreement(
            spoilt, replace(plain.folder if of_its_own else read_folder(spoilt, edited=True), edits=(edit.file,))
        )
    assert caught.value.file == edit.file
    assert edit.ends in caught.value.reason


def test_one_that_differs_ends_the_load(spoilt: Path) -> None:
    with (
        _edited(spoilt, ENDED[-1]),
        pytest.raises(MockError, match="no run would show it: have every file say the same"),
    ):
        load(spoilt, edited=True)


def test_edit_that_no_run_shows_is_told(spoilt: Path) -> None:
    notes: list[str] = []
    for executed in (True, False):
        with _edited(spoilt, *(edit for edit in NOT_SHOWN if edit.file.endswith("mock.urdf") is executed)):
            notes += load(spoilt, edited=True).notes
    for edit in NOT_SHOWN:
        assert f"`{edit.file}` differs from the manifest: it was edited after it was generated" in notes
        assert any(note.startswith(f"`{edit.file}` ") and edit.not_shown in note for note in notes), edit


@pytest.mark.parametrize("name", CELLS)
def test_files_of_a_generated_folder_say_what_is_executed(name: str) -> None:
    folder = ROOT / "generated" / name
    read = read_folder(folder)
    notes = refuse_disagreement(folder, replace(read, edits=read.listed))
    assert {note.split("`")[1] for note in notes} <= set(read.listed)


def test_page_has_the_edits_and_kinds_of_files_that_are_tried() -> None:
    assert PAGE.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0] == f"\n{table()}\n"
    assert len(EDITS) >= 57
    assert all(bool(edit.runs) + bool(edit.ends) + bool(edit.not_shown) == 1 for edit in EDITS)
