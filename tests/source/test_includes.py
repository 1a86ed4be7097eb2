"""Specs in several files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.source import read
from tests.cells import there
from tests.source.reading import codes, places


def _write(folder: Path, **files: str) -> Path:
    for name, text in files.items():
        path = folder / f"{name.replace('__', '/')}.yaml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "cell.yaml"


def test_sections_are_merged_and_keep_their_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    _write(
        tmp_path / "c",
        cell="include: [parts/a.yaml]\ncell: x\ndevices:\n  arm: {m: 1}\n",
        parts__a="include: b.yaml\ndevices:\n  cam: {m: 2}\n",
        parts__b="frames:\n  f: 3\n",
    )
    outcome = read("c/cell.yaml")
    assert outcome.ok
    assert outcome.value is not None
    assert outcome.value.data == {"cell": "x", "devices": {"arm": {"m": 1}, "cam": {"m": 2}}, "frames": {"f": 3}}
    assert str(outcome.value.locate(("devices", "cam", "m"))) == "c/parts/a.yaml:3:12"
    assert str(outcome.value.locate(("devices", "arm", "m"))) == "c/cell.yaml:4:12"
    assert str(outcome.value.locate(("frames", "f"))) == "c/parts/b.yaml:2:6"
    assert sorted(outcome.value.texts) == ["c/cell.yaml", "c/parts/a.yaml", "c/parts/b.yaml"]


def test_same_key_in_two_files_is_reported_with_the_first_place(tmp_path: Path) -> None:
    outcome = read(_write(tmp_path, cell="include: a.yaml\nd: {arm: 1}\ncell: x\n", a="d:\n  arm: 2\ncell: y\n"))
    assert places(outcome) == [("duplicate-key", 2, 3), ("duplicate-key", 3, 1)]
    first = outcome.diagnostics[0]
    assert first.span.file.endswith("/a.yaml")
    assert str(first.related[0].span).endswith("/cell.yaml:2:5")


def test_mapping_and_list_do_not_merge(tmp_path: Path) -> None:
    assert codes(read(_write(tmp_path, cell="include: a.yaml\nd: {arm: 1}\n", a="d: [1]\n"))) == ["key-collision"]


def test_file_reached_twice_is_read_once(tmp_path: Path) -> None:
    path = _write(
        tmp_path,
        cell="include: [a.yaml, b.yaml]\n",
        a="include: c.yaml\na: 1\n",
        b="include: c.yaml\nb: 1\n",
        c="c: 1\n",
    )
    outcome = read(path)
    assert outcome.ok
    assert there(outcome.value).data == {"a": 1, "c": 1, "b": 1}


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("include: 5", "include-shape"),
        ("include: {a: b}", "include-shape"),
        ("include: [a, [b]]", "include-shape"),
        ("include: ''", "include-shape"),
        ("include: /etc/hostname", "include-escape"),
        ("include: ../other.yaml", "include-escape"),
        ("include: link.yaml", "include-escape"),
        ("include: gone.yaml", "file-not-found"),
        ("include: .", "not-a-file"),
        ('include: "a\\0b"', "control-character"),
        ("include: cell.yaml", "include-cycle"),
    ],
)
def test_bad_include_is_marked_where_it_is_written(tmp_path: Path, line: str, code: str) -> None:
    path = _write(tmp_path / "inside", cell=f"a: 1\n{line}\n")
    (tmp_path / "other.yaml").write_text("b: 1\n")
    (tmp_path / "inside" / "link.yaml").symlink_to(tmp_path / "other.yaml")
    outcome = read(path)
    assert codes(outcome) == [code]
    assert outcome.diagnostics[0].span.line == 2
    assert outcome.diagnostics[0].span.file == str(path)


def test_cycle_through_another_file_is_reported(tmp_path: Path) -> None:
    outcome = read(_write(tmp_path, cell="include: a.yaml\nx: 1\n", a="y: 1\ninclude: cell.yaml\n"))
    assert places(outcome) == [("include-cycle", 2, 10)]


def test_thirty_two_files_are_read_and_one_more_is_not(tmp_path: Path) -> None:
    chain = {f"p{i}": f"k{i}: 1\ninclude: p{i + 1}.yaml\n" for i in range(1, 31)}
    assert codes(read(_write(tmp_path, cell="include: p1.yaml\n", **chain, p31="k: 1\n"))) == []
    assert codes(read(_write(tmp_path, p31="k: 1\ninclude: p32.yaml\n", p32="z: 1\n").parent / "cell.yaml")) == [
        "too-many-includes"
    ]


def test_mistakes_of_all_files_are_told_at_once(tmp_path: Path) -> None:
    outcome = read(_write(tmp_path, cell="include: [a.yaml, b.yaml]\n", a="x: 1\nx: 2\n", b="<robot/>\n"))
    assert codes(outcome) == ["duplicate-key", "not-yaml"]
    assert len(there(outcome.value).texts) == 3
