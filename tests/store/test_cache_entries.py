"""Entries: whole or none, and not too many."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cellc.store import cache
from cellc.store.cache import read_entry, write_entry


@pytest.fixture(name="home", autouse=True)
def home_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "cellc"


def test_an_entry_is_read_as_it_was_written() -> None:
    write_entry("kind/name", b"line\nline\n\xff")
    assert read_entry("kind/name") == b"line\nline\n\xff"
    assert read_entry("kind/other") is None


@pytest.mark.parametrize("position", [0, 30, 64, 65, 70, -1])
def test_one_changed_byte_anywhere_is_noticed(position: int, home: Path) -> None:
    write_entry("kind/name", b"0123456789")
    content = bytearray((home / "kind/name").read_bytes())
    content[position] ^= 1
    (home / "kind/name").write_bytes(content)
    assert read_entry("kind/name") is None


def test_the_older_half_goes_where_there_are_too_many(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "MAX_ENTRIES", 10)
    for number in range(11):
        write_entry(f"kind/{number}", b"")
        if number < 10:
            os.utime(home / f"kind/{number}", (number, number))
    left = {int(file.name) for file in (home / "kind").iterdir()}
    assert left == set(range(5, 11))


def test_a_huge_entry_is_neither_written_nor_read(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_entry("kind/name", b"0123456789")
    monkeypatch.setattr(cache, "MAX_BYTES", 60)
    assert read_entry("kind/name") is None
    write_entry("kind/huge", bytes(range(100)))
    assert not (home / "kind/huge").exists()


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="the system has no numbers of users")
def test_an_entry_of_another_user_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    write_entry("kind/name", b"0123456789")
    monkeypatch.setattr(os, "getuid", lambda: -1)
    assert read_entry("kind/name") is None
