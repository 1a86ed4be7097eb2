"""What was asked of the disk is written down, and asked again it shows every change."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

from cellc import disk
from cellc.disk import Record, include_in_work, not_to_be_kept, recorded, unrecorded
from cellc.disk.again import still_says

Ask = Callable[[Path], object]

QUESTIONS: dict[str, Ask] = {
    "status": lambda path: disk.status(path),
    "kind": lambda path: disk.kind_of(path),
    "contents": lambda path: disk.contents(path, 100),
    "real path": lambda path: disk.real_path(path),
    "names": lambda path: disk.names_in(path),
    "matches": lambda path: disk.matches(f"{path}*"),
}
STATES: dict[str, Callable[[Path], object]] = {
    "nothing": lambda path: None,
    "a file": lambda path: path.write_text("one"),
    "another file": lambda path: path.write_text("another"),
    "an empty folder": lambda path: path.mkdir(),
    "a folder": lambda path: _folder_with_a_file(path),
    "a link": lambda path: path.symlink_to("elsewhere"),
    "a link to itself": lambda path: path.symlink_to(path.name),
}
# What a question cannot tell apart, and need not.
ALIKE = {
    "status": [{"nothing", "a link"}, {"an empty folder", "a folder"}],
    "kind": [{"nothing", "a link"}, {"an empty folder", "a folder"}],
    "contents": [{"nothing", "a link"}, {"an empty folder", "a folder"}],
    "real path": [{"nothing", "a file", "another file", "an empty folder", "a folder", "a link to itself"}],
    "names": [{"nothing", "a link"}, {"a file", "another file"}],
    # The pattern is `thing*`: a link counts whether or not it leads anywhere.
    "matches": [{"a file", "another file", "an empty folder", "a folder", "a link", "a link to itself"}],
}


def _asked(ask: Ask, path: Path) -> Record:
    with recorded() as record, suppress(OSError):
        ask(path)
    return record


@pytest.mark.skipif(os.name != "posix", reason="makes symbolic links")
@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("before", STATES)
@pytest.mark.parametrize("after", STATES)
def test_every_change_shows(question: str, before: str, after: str, tmp_path: Path) -> None:
    path = tmp_path / "thing"
    for folder, state in (("before", before), ("after", after)):
        (tmp_path / folder).mkdir()
        STATES[state](tmp_path / folder / "thing")
    (tmp_path / "now").symlink_to("before")
    # The folder is exchanged as a whole, so that times and numbers of files cannot help.
    path = tmp_path / "now/thing"
    if question == "real path":  # is about the folders too: take the files from one place instead
        path = tmp_path / "thing"
        STATES[before](path)
    marks = _asked(QUESTIONS[question], path).marks
    assert still_says(marks)
    if question == "real path":
        _remove(path)
        STATES[after](path)
    else:
        (tmp_path / "now").unlink()
        (tmp_path / "now").symlink_to("after")
    alike = before == after or any({before, after} <= group for group in ALIKE[question])
    assert still_says(marks) == alike


def _folder_with_a_file(path: Path) -> None:
    path.mkdir()
    (path / "inside").write_text("")


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        for inside in path.iterdir():
            inside.unlink()
        path.rmdir()
    else:
        path.unlink(missing_ok=True)


def test_a_name_with_a_zero_character_is_an_answer_too() -> None:
    with recorded() as record, pytest.raises(ValueError, match="null"):
        disk.status("a\0b")
    assert record.holds
    assert still_says(record.marks)


def test_two_answers_to_one_question_are_not_to_be_kept(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("one")
    with recorded() as record:
        disk.contents(file, 10)
        file.write_text("two")
        disk.contents(file, 10)
    assert not record.holds


def test_chance_is_not_to_be_kept() -> None:
    with recorded() as record:
        not_to_be_kept()
    assert not record.holds


def test_files_of_the_package_are_not_written_down(tmp_path: Path) -> None:
    with recorded() as record:
        with unrecorded():
            disk.kind_of(tmp_path)
        disk.kind_of(tmp_path / "other")
    assert [path for _, path, _ in record.marks] == [str(tmp_path / "other")]


def test_nobody_writes_down_what_nobody_wants(tmp_path: Path) -> None:
    not_to_be_kept()
    include_in_work(Record(holds=False))
    assert disk.kind_of(tmp_path) == "folder"


def test_what_a_child_asked_is_taken_over(tmp_path: Path) -> None:
    child = _asked(lambda path: disk.kind_of(path), tmp_path)
    with recorded() as record:
        include_in_work(Record.from_plain(child.to_plain()))
    assert record == child
    with recorded() as record:
        include_in_work(Record(holds=False))
    assert not record.holds


def test_a_question_of_another_release_is_not_answered() -> None:
    assert not still_says({("phase of the moon", ".", 0): "full"})
