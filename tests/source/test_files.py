"""Paths and bytes that are no spec at all."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from cellc.compiler.source import Plain, read
from cellc.compiler.source.compose import compose
from cellc.contract.diagnostics import Span
from cellc.contract.limits import limits
from tests.cells import there
from tests.properties import given, settings, st
from tests.source.reading import codes, read_bytes


def test_missing_file_names_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "cell.yaml").write_text("a: 1\n")
    (found,) = read(tmp_path / "cel.yaml").diagnostics
    assert found.code == "file-not-found"
    assert "`cell.yaml`" in found.help


@pytest.mark.parametrize("path", ["nowhere/cell.yaml", "\0", "x" * 5000, ""])
def test_impossible_path_is_reported(path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert codes(read(path))[0] in ("file-not-found", "file-unreadable", "not-a-file")


def test_folder_and_device_are_no_files(tmp_path: Path) -> None:
    assert codes(read(tmp_path)) == ["not-a-file"]
    assert codes(read("/dev/null")) == ["not-a-file"]


def test_pipe_is_refused_without_waiting_for_a_writer(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert codes(read(tmp_path / "pipe")) == ["not-a-file"]


def test_link_to_itself_is_reported(tmp_path: Path) -> None:
    (tmp_path / "loop.yaml").symlink_to(tmp_path / "loop.yaml")
    assert codes(read(tmp_path / "loop.yaml")) == ["file-unreadable"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_file_without_permission_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "cell.yaml"
    path.write_text("a: 1\n")
    path.chmod(0)
    assert codes(read(path)) == ["file-unreadable"]


def test_fifty_megabytes_are_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "big.yaml"
    with path.open("wb") as file:
        file.truncate(50 * 1024**2)
    (found,) = read(path).diagnostics
    assert found.code == "file-too-large"
    assert "50.0 MiB" in found.message


@pytest.mark.parametrize(
    "content",
    ["a: 1\n".encode("utf-16"), "a: 1\n".encode("utf-16-le"), b"\x7fELF\x02\0\0", b"a: 1\nb: \xff\n", b"a: b\0c\n"],
)
def test_other_encodings_and_binaries_are_refused(tmp_path: Path, content: bytes) -> None:
    assert codes(read_bytes(tmp_path, content)) == ["not-utf8"]


def test_bad_byte_is_marked(tmp_path: Path) -> None:
    (found,) = read_bytes(tmp_path, "a: 1\nb: é".encode() + b"\xff\n").diagnostics
    assert (found.span.line, found.span.column) == (2, 5)


def test_file_is_named_as_the_user_named_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cell.yaml").write_text("a: 1\n")
    outcome = read("./cell.yaml")
    assert outcome.value is not None
    assert outcome.value.file == "./cell.yaml"
    assert outcome.value.locate(()) == Span("./cell.yaml", 1, 1, 1, 1)


_REUSE = settings(max_examples=150)
_MARKS = ["a", "b", ": ", "- ", "  ", "[", "]", "{", "}", '"', "'", "#", "&x ", "*x", ">", "1", "\t", "? ", "!t ", "<<"]
_WORDS = ["é", "\\", "0x1", "~"]
_PIECES = st.sampled_from([*_MARKS, *_WORDS, ", ", "\n", "|\n", "---\n", "%YAML 1.2\n", "\r\n", "include: cell.yaml\n"])


@_REUSE
@given(content=st.binary(max_size=300))
def test_no_bytes_raise(tmp_path: Path, content: bytes) -> None:
    outcome = read_bytes(tmp_path, content)
    assert outcome.ok or outcome.diagnostics


@_REUSE
@given(pieces=st.lists(_PIECES, max_size=40))
def test_no_text_raises_and_every_finding_points_into_it(tmp_path: Path, pieces: list[str]) -> None:
    outcome = read_bytes(tmp_path, "".join(pieces))
    for found in outcome.diagnostics:
        text = there(outcome.value).texts.get(found.span.file, "")
        assert 1 <= found.span.line <= text.count("\n") + 1


@_REUSE
@given(pieces=st.lists(_PIECES, max_size=40))
def test_both_parsers_give_the_same_values_at_the_same_places(pieces: list[str]) -> None:
    text = "".join(pieces).replace("\r\n", "\n")
    fast, pure = compose("f", text), compose("f", text, pure=True)
    if fast.value is not None and pure.value is not None:
        assert repr(fast.value) == repr(pure.value)


_ALLOWED = st.characters(min_codepoint=0x20, max_codepoint=0x7E, exclude_characters="$", include_characters="\t\n")

_DATA: st.SearchStrategy[Plain] = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.text(_ALLOWED, max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text("abc", min_size=1), inner, max_size=4),
    max_leaves=20,
)


@_REUSE
@given(data=st.dictionaries(st.text("xyz", min_size=1), _DATA, min_size=1, max_size=4))
def test_json_means_what_it_means_to_a_json_reader(tmp_path: Path, data: dict[str, Plain]) -> None:
    text = json.dumps(data, indent=2)
    outcome = read_bytes(tmp_path, text)
    if "include" not in data and data != {}:
        assert there(outcome.value).data == json.loads(text)


def test_text_of_an_editor_is_bounded_as_a_file_is(tmp_path: Path) -> None:
    name = (tmp_path / "cell.yaml").as_posix()
    found = read(name, {name: "#" * (limits().spec_bytes + 1)}).diagnostics
    assert [finding.code for finding in found] == ["file-too-large"]
