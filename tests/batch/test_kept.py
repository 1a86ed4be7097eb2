"""A kept answer holds while the program and the disk are the same, and never a moment longer."""

from __future__ import annotations

import json
import os
import shutil
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest

from cellc.batch.compute import compute
from tests.batch.counting import Counting, answer
from tests.cli.run import MINIMAL

Change = Callable[[Path], object]


def _appended(name: str, text: str = "\n") -> Change:
    def change(folder: Path) -> None:
        with (folder / name).open("a", encoding="utf-8") as file:
            file.write(text)

    return change


def _written(name: str, text: str) -> Change:
    def change(folder: Path) -> None:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

    return change


def _becomes_folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


_EMPTY = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>\n'

CHANGES: dict[str, Change] = {
    "the spec": _appended("cell.yaml"),
    "what it includes": _appended("more.yaml"),
    "the facts of a device": _appended("my_robot/device.yaml"),
    "a description": _appended("my_robot/robot.urdf.xacro"),
    "what a description includes": _appended("my_robot/part.xacro"),
    "one of the files that fit a pattern": _appended("my_robot/parts/one.xacro"),
    "what a package holds": _appended("src/shapes/shape.xacro"),
    "a table of a description": _written("my_robot/facts.yaml", "stroke: 0.4\n"),
    "one more file fits a pattern": _written("my_robot/parts/two.xacro", _EMPTY),
    "an optional include comes to be": _written("my_robot/some_day.xacro", _EMPTY),
    "a nearer folder of a package comes to be": _written("shapes/shape.xacro", _EMPTY),
    "the spec is gone": lambda folder: (folder / "cell.yaml").unlink(),
    "an include is gone": lambda folder: (folder / "more.yaml").unlink(),
    "an include has become a folder": lambda folder: _becomes_folder(folder / "more.yaml"),
    "the folder of a device is gone": lambda folder: (folder / "my_robot").rename(folder / "elsewhere"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_of_the_disk_is_answered_anew(change: str, folder: Path, computed: Counting) -> None:
    answer("cell.yaml")
    CHANGES[change](folder)
    answered = answer("cell.yaml")
    assert len(computed.files) == 2
    assert answered == compute("check", "cell.yaml")[0]


@pytest.mark.usefixtures("folder")
def test_nothing_is_computed_while_nothing_changes(computed: Counting) -> None:
    first = answer("cell.yaml")
    assert [answer("cell.yaml") for _ in range(3)] == [first] * 3
    assert computed.files == ["cell.yaml"]


def test_times_of_files_do_not_count(folder: Path, computed: Counting) -> None:
    answer("cell.yaml")
    os.utime(folder / "cell.yaml", (1, 1))
    answer("cell.yaml")
    assert len(computed.files) == 1


def test_same_size_and_time_with_other_content_is_answered_anew(folder: Path, computed: Counting) -> None:
    table = folder / "my_robot/facts.yaml"
    before = table.stat()
    answer("cell.yaml")
    table.write_text("stroke: 0.9\n", encoding="utf-8")
    os.utime(table, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert table.stat().st_size == before.st_size
    answer("cell.yaml")
    assert len(computed.files) == 2


def test_what_was_missing_is_looked_for_again(folder: Path, computed: Counting) -> None:
    (folder / "my_robot").rename(folder / "away")
    assert "unknown-model" in {found.code for found in answer("cell.yaml").findings.diagnostics}
    (folder / "away").rename(folder / "my_robot")
    assert "unknown-model" not in {found.code for found in answer("cell.yaml").findings.diagnostics}
    assert len(computed.files) == 2


def test_a_suggested_name_follows_the_folder(folder: Path, computed: Counting) -> None:
    (missing,) = answer("cel.yaml").findings.diagnostics
    assert "`cell.yaml`" in missing.help
    (folder / "cell.yaml").rename(folder / "something_else.yaml")
    (missing,) = answer("cel.yaml").findings.diagnostics
    assert "`cell.yaml`" not in missing.help
    assert len(computed.files) == 2


@pytest.mark.skipif(os.name != "posix", reason="makes symbolic links")
def test_a_link_that_leads_elsewhere_is_answered_anew(folder: Path, computed: Counting) -> None:
    outside = folder.parent / "outside.yaml"
    (folder / "more.yaml").rename(outside)
    (folder / "beside.yaml").write_text(outside.read_text(), encoding="utf-8")
    (folder / "more.yaml").symlink_to("beside.yaml")
    assert "include-escape" not in {found.code for found in answer("cell.yaml").findings.diagnostics}
    (folder / "more.yaml").unlink()
    (folder / "more.yaml").symlink_to(outside)  # the same text, but not one that may be read
    assert "include-escape" in {found.code for found in answer("cell.yaml").findings.diagnostics}
    assert len(computed.files) == 2


@pytest.mark.usefixtures("folder")
def test_another_program_answers_itself(computed: Counting) -> None:
    for program in ("one", "other", "other"):
        answer("cell.yaml", program)
    assert len(computed.files) == 2


@pytest.mark.usefixtures("folder")
def test_without_a_mark_of_the_program_nothing_is_kept_or_recalled(computed: Counting) -> None:
    answer("cell.yaml", "program")
    answer("cell.yaml", None)
    answer("cell.yaml", None)
    assert len(computed.files) == 3


def test_cells_of_one_name_in_two_folders_do_not_displace_each_other(
    folder: Path, computed: Counting, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(folder, folder.parent / "other")
    for name in ("cell", "other", "cell", "other"):
        monkeypatch.chdir(folder.parent / name)
        answer("cell.yaml")
    assert len(computed.files) == 2


def test_a_spec_is_told_as_it_was_named(folder: Path, computed: Counting, monkeypatch: pytest.MonkeyPatch) -> None:
    answer("cell.yaml")
    monkeypatch.chdir(folder.parent)
    assert answer("cell/cell.yaml").findings.file == "cell/cell.yaml"
    assert len(computed.files) == 2


@pytest.mark.usefixtures("folder")
def test_checking_and_compiling_are_two_answers(computed: Counting) -> None:
    assert answer(MINIMAL, kind="compile").artifacts is not None
    assert answer(MINIMAL, kind="check").artifacts is None
    assert len(computed.files) == 2


def _entry(folder: Path) -> Path:
    (entry,) = (folder.parent / "cache/cellc/check").iterdir()
    return entry


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda content: b"",
    "cut": lambda content: content[:-1],
    "a changed letter": lambda content: bytes((content[0] ^ 1, *content[1:])),
    "another file": lambda content: b"{}",
    "bytes": lambda content: bytes(range(256)),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_entry_costs_time_only(damage: str, folder: Path, computed: Counting) -> None:
    first = answer("cell.yaml")
    content = _entry(folder).read_bytes()
    _entry(folder).write_bytes(DAMAGES[damage](content))
    assert answer("cell.yaml") == first
    assert len(computed.files) == 2
    assert _entry(folder).read_bytes() == content


@pytest.mark.parametrize("strange", [b"[]", b"{}", b'{"program": "this program"}', b"1", b"\xff", b"[" * 10_000])
def test_an_entry_of_another_shape_costs_time_only(
    strange: bytes, folder: Path, computed: Counting, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = answer("cell.yaml")
    monkeypatch.setattr("cellc.batch.kept.read_entry", lambda name: strange)
    assert answer("cell.yaml") == first
    assert len(computed.files) == 2


def test_a_cache_folder_that_cannot_be_written_costs_time_only(folder: Path, computed: Counting) -> None:
    (folder.parent / "cache").write_text("a file in the place of the folder")
    assert answer("cell.yaml") == answer("cell.yaml")
    assert len(computed.files) == 2


def test_the_cache_can_be_turned_off(folder: Path, computed: Counting, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    assert answer("cell.yaml") == answer("cell.yaml")
    assert len(computed.files) == 2
    assert not (folder.parent / "cache").exists()


def test_an_answer_cut_short_by_the_time_it_took_is_not_kept(
    folder: Path, computed: Counting, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cellc.description.xacro_expander.WALL_SECONDS", 0.0)
    monkeypatch.setattr("cellc.description.xacro_expander.expand_xacro.__defaults__", (0.0,))
    assert "xacro-too-large" in {found.code for found in answer("cell.yaml").findings.diagnostics}
    monkeypatch.undo()
    assert not (folder.parent / "cache").exists()
    assert len(computed.files) == 1


def test_an_entry_says_what_was_asked(folder: Path, computed: Counting) -> None:
    answer("cell.yaml")
    asked = json.loads(zlib.decompress(_entry(folder).read_bytes().partition(b"\n")[2]))["asked"]["marks"]
    read = {path for what, path, _, _ in asked if what == "contents"}
    assert {"cell.yaml", "more.yaml", "my_robot/device.yaml", "my_robot/facts.yaml"} <= read
    assert computed.files == ["cell.yaml"]
