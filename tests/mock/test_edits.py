"""Every edit of a generated folder by hand is refused; with `--edited` it is executed, refused too, or a note."""

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
from cellc.mock.by_hand import FOR_PEOPLE, not_executed, notes_on, refuse_not_executed
from cellc.mock.cell import read_to_run, read_to_show
from cellc.mock.folder import differences, read_folder
from cellc.mock.result import RehearsalResult
from tests.cells import CELLS, ROOT
from tests.mock.edits import BEGIN, EDITS, END, PAGE, Edit, table

PLAIN = ROOT / "generated" / "ur5e_pick"
RUN = [edit for edit in EDITS if edit.runs]
REFUSED = [edit for edit in EDITS if edit.refused]
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
    return replace(
        result, edited=False, attempts=tuple(replace(attempt, configuration_id="") for attempt in result.attempts)
    )


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


@pytest.mark.parametrize("edit", REFUSED, ids=lambda edit: f"{edit.file}: {edit.what}")
def test_edit_of_what_is_not_executed_is_refused(edit: Edit, spoilt: Path) -> None:
    with _edited(spoilt, edit), pytest.raises(MockError) as caught:
        read_to_run(spoilt, edited=True)
    assert caught.value.file == edit.file
    assert caught.value.reason.startswith("was edited or removed by hand, and is not executed")


def test_every_file_of_several_is_named(plain: MockCell) -> None:
    files = [f"config/{number}.yaml" for number in range(14)]
    with pytest.raises(MockError) as caught:
        refuse_not_executed(replace(plain.folder, edits=("README.md", *files[:3])))
    assert str(caught.value).startswith(
        f"{files[0]}: was edited or removed by hand, as `{files[1]}`, `{files[2]}`, and is"
    )
    with pytest.raises(MockError, match=r", `config/11\.yaml` and 2 more, and is not executed"):
        refuse_not_executed(replace(plain.folder, edits=tuple(files)))


def test_file_that_was_removed_is_refused(spoilt: Path) -> None:
    (spoilt / "config/joint_limits.yaml").unlink()
    try:
        with pytest.raises(MockError, match=r"joint_limits\.yaml: was edited or removed by hand, and is not executed"):
            load(spoilt, edited=True)
    finally:
        shutil.copy(PLAIN / "config/joint_limits.yaml", spoilt / "config/joint_limits.yaml")


def test_edit_that_no_run_shows_is_a_note_of_every_result(spoilt: Path) -> None:
    for edit in NOT_SHOWN:
        with _edited(spoilt, edit):
            cell = load(spoilt, edited=True)
        assert any(note.startswith(f"`{edit.file}` ") and edit.not_shown in note for note in cell.notes), edit
        assert cell.run("canceled").edited


def test_a_page_of_an_edited_folder_names_what_is_not_executed(spoilt: Path) -> None:
    edit = REFUSED[0]
    with _edited(spoilt, edit):
        notes = read_to_show(spoilt, edited=True).notes
    assert f"`{edit.file}` was edited or removed by hand, and is not executed" in notes


@pytest.mark.parametrize("name", CELLS)
def test_every_generated_file_is_executed_or_refused_or_read_by_people_alone(name: str) -> None:
    read = read_folder(ROOT / "generated" / name)
    whole = replace(read, edits=read.listed)
    files = read.contract.files
    # docs/mock.md, "What it reads".
    executed = {"contract.json", "config/uncertainty.json", files.rehearsals, files.urdf_mock, files.bring_up}
    executed |= {*files.parameters.values(), *files.stages.values(), *filter(None, (files.srdf,))}
    assert {*not_executed(whole)} == {
        entry for entry in read.listed if entry not in executed and not entry.endswith(FOR_PEOPLE)
    }
    assert list(notes_on(read)) == []


def test_page_has_the_edits_that_are_tried() -> None:
    assert PAGE.read_text(encoding="utf-8").partition(BEGIN)[2].partition(END)[0] == f"\n{table()}\n"
    assert len(EDITS) >= 68
    assert all(bool(edit.runs) + edit.refused + bool(edit.not_shown) == 1 for edit in EDITS)
