"""Values by the core schema of YAML 1.2.2 (chapter 10.3.2), and where they stand."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from cellc.compiler.source import Plain
from cellc.contract.diagnostics import Span
from tests.source.reading import document, places, read_bytes


@pytest.mark.parametrize(
    ("text", "value"),
    [
        # The examples of YAML 1.2.2, 10.3.2.
        ("null", None),
        ("~", None),
        ("", None),
        ("true", True),
        ("False", False),
        ("0", 0),
        ("0o7", 7),
        ("0x3A", 58),
        ("-19", -19),
        ("0.", 0.0),
        ("-0.0", 0.0),
        (".5", 0.5),
        ("+12e03", 12000.0),
        ("-2E+05", -200000.0),
        (".inf", math.inf),
        ("-.Inf", -math.inf),
        # What YAML 1.1 reads as something else.
        ("on", "on"),
        ("yes", "yes"),
        ("010", 10),
        ("12:30:00", "12:30:00"),
        ("2026-07-01", "2026-07-01"),
        ("1_000", "1_000"),
        ("1e3", 1000.0),
        ('"5"', "5"),
        ("'true'", "true"),
        ("500 Hz", "500 Hz"),
    ],
)
def test_scalar_follows_yaml_1_2(tmp_path: Path, text: str, value: Plain) -> None:
    data = document(tmp_path, f"x: {text}\n").data
    assert data == {"x": value}
    assert isinstance(data, dict)
    assert type(data["x"]) is type(value)


def test_nan_is_a_number(tmp_path: Path) -> None:
    data = document(tmp_path, "x: .nan\n").data
    assert isinstance(data, dict)
    assert isinstance(data["x"], float)
    assert math.isnan(data["x"])


@pytest.mark.parametrize("text", ["9223372036854775808", "1e999", "9" * 5000, "0xFFFFFFFFFFFFFFFF0"])
def test_number_beyond_64_bits_is_reported(tmp_path: Path, text: str) -> None:
    assert places(read_bytes(tmp_path, f"a: 1\nx: {text}\n")) == [("number-out-of-range", 2, 4)]


def test_largest_integer_is_read(tmp_path: Path) -> None:
    assert document(tmp_path, "x: 9223372036854775807\n").data == {"x": 2**63 - 1}


SPEC = """\
cell: demo  # a comment
devices:
  arm:
    mount: {parent: world, xyz: 0 0 1 m}
    empty:
steps:
- move: home
- [1, 2]
note: |
  two
  lines

last: "q"
"""


@pytest.mark.parametrize(
    ("path", "line", "start", "end_line", "end"),
    [
        ((), 1, 1, 1, 1),
        (("cell",), 1, 7, 1, 11),
        (("devices",), 2, 1, 2, 8),
        (("devices", "arm"), 3, 3, 3, 6),
        (("devices", "arm", "mount", "xyz"), 4, 33, 4, 40),
        (("devices", "arm", "empty"), 5, 5, 5, 10),
        (("devices", "arm", "missing", "deeper"), 3, 3, 3, 6),
        (("steps", 0), 7, 3, 7, 7),
        (("steps", 0, "move"), 7, 9, 7, 13),
        (("steps", 1), 8, 3, 8, 9),
        (("steps", 1, 1), 8, 7, 8, 8),
        (("steps", 9), 6, 1, 6, 6),
        (("note",), 9, 7, 11, 8),
        (("last",), 13, 7, 13, 10),
    ],
)
def test_every_path_has_its_place(
    tmp_path: Path, path: tuple[str | int, ...], line: int, start: int, end_line: int, end: int
) -> None:
    read = document(tmp_path, SPEC)
    assert read.locate(path) == Span(read.file, line, start, end_line, end)


def test_key_has_its_own_place(tmp_path: Path) -> None:
    read = document(tmp_path, SPEC)
    assert read.locate_key(("cell",)) == Span(read.file, 1, 1, 1, 5)
    assert read.locate_key(("steps", 1)) == read.locate(("steps", 1))


def test_presence_and_raw_text_of_paths(tmp_path: Path) -> None:
    read = document(tmp_path, "a: {b: 0x1F}\nc:\n")
    assert read.has(())
    assert read.has(("a", "b"))
    assert read.has(("c",))
    assert not read.has(("a", "b", "d"))
    assert not read.has(("a", 0))
    assert read.text_at(("a", "b")) == "0x1F"
    assert read.text_at(("a",)) == ""


def test_columns_count_characters_and_crlf_is_one_line_break(tmp_path: Path) -> None:
    read = document(tmp_path, b"\xef\xbb\xbf" + "漢: é\r\nb: {c: 1}\r\n".encode())
    assert read.data == {"漢": "é", "b": {"c": 1}}
    assert read.locate(("漢",)) == Span(read.file, 1, 4, 1, 5)
    assert read.locate(("b", "c")) == Span(read.file, 2, 8, 2, 9)
    assert read.texts[read.file] == "漢: é\nb: {c: 1}\n"


def test_alias_is_marked_where_it_stands_and_its_content_at_the_anchor(tmp_path: Path) -> None:
    read = document(tmp_path, "a: &x {k: 1}\nb: *x\nc: &y 5\nd: *y\n")
    assert read.data == {"a": {"k": 1}, "b": {"k": 1}, "c": 5, "d": 5}
    assert str(read.locate(("b", "k"))).endswith(":1:11")
    assert str(read.locate(("b",))).endswith(":2:1")
    assert str(read.locate(("d",))).endswith(":4:4")


def test_a_value_is_taken_out_and_every_other_keeps_its_place(tmp_path: Path) -> None:
    written = document(tmp_path, "a: {b: [1, 2, 3], c: 4}\nd: 5\n")
    less = written.without(("a", "b", 1))
    assert less.data == {"a": {"b": [1, 3], "c": 4}, "d": 5}
    assert less.locate(("a", "b", 1)) == written.locate(("a", "b", 2))
    assert less.locate(("d",)) == written.locate(("d",))
    assert less.without(("a",)).with_value("e", {"f": 6}).data == {"d": 5, "e": {"f": 6}}
    assert written.data == {"a": {"b": [1, 2, 3], "c": 4}, "d": 5}
