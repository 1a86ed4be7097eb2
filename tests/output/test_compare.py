"""A comparison names each file that a build would change, and why."""

from __future__ import annotations

from pathlib import Path

from cellc.compiler.output.compare import Difference, compare
from cellc.compiler.output.write import write
from tests.output.building import build_of, contents

FIRST = build_of(a_txt="one\ntwo\nthree\n", b_txt="b\n", d_txt="d\n")


def _but_manifest(differences: tuple[Difference, ...]) -> list[Difference]:
    return [difference for difference in differences if difference.path != "manifest.json"]


def test_folder_as_built_has_no_difference(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    assert compare(FIRST, tmp_path) == ()


def test_absent_folder_misses_every_file_and_is_not_made(tmp_path: Path) -> None:
    found = compare(FIRST, tmp_path / "small")
    assert [(d.path, d.kind) for d in found] == [
        ("a.txt", "missing"), ("b.txt", "missing"), ("d.txt", "missing"), ("manifest.json", "missing")
    ]  # fmt: skip
    assert contents(tmp_path) == {}


def test_older_build_is_told_with_its_first_other_line(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    second = build_of(a_txt="one\n2\nthree\n", b_txt="b\n", e_txt="e\n")
    assert _but_manifest(compare(second, tmp_path)) == [
        Difference("a.txt", "outdated", 2, "2", "two"),
        Difference("d.txt", "unexpected"),
        Difference("e.txt", "missing"),
    ]


def test_edit_is_told_apart_from_an_older_build(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "b.txt").write_text("b\nmore\n")
    assert compare(FIRST, tmp_path) == (Difference("b.txt", "edited", 2, "", "more"),)


def test_line_that_is_missing_at_the_end_is_told(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "b.txt").write_bytes(b"b")
    assert compare(FIRST, tmp_path) == (Difference("b.txt", "edited", 2, "", None),)


def test_carriage_return_is_a_difference(tmp_path: Path) -> None:
    write(FIRST, tmp_path)
    (tmp_path / "b.txt").write_bytes(b"b\r\n")
    assert compare(FIRST, tmp_path) == (Difference("b.txt", "edited", 1, "b", "b\r"),)
