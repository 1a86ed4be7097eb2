"""Entries: whole or none, and not too many."""

from __future__ import annotations

import hashlib
import os
import zlib
from pathlib import Path

import pytest

from cellc.contract.store import cache, cache_key
from cellc.contract.store.cache import read_entry, write_entry


@pytest.fixture(name="home", autouse=True)
def home_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    cache_key._key_in.cache_clear()
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
        write_entry(f"kind/{number:064x}.json", b"")
        if number < 10:
            os.utime(home / f"kind/{number:064x}.json", (number, number))
    left = {int(file.stem, 16) for file in (home / "kind").iterdir()}
    assert left == set(range(5, 11))


def test_a_huge_entry_is_neither_written_nor_read(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_entry("kind/name", b"0123456789")
    monkeypatch.setattr(cache, "MAX_BYTES", 60)
    assert read_entry("kind/name") is None
    write_entry("kind/huge", bytes(range(100)))
    assert not (home / "kind/huge").exists()


def test_a_cache_of_another_user_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    write_entry("kind/name", b"0123456789")
    monkeypatch.setattr(os, "getuid", lambda: -1)
    assert read_entry("kind/name") is None


def test_the_bytes_of_one_entry_are_no_answer_in_the_place_of_another(home: Path) -> None:
    write_entry("kind/first", b"the first answer")
    write_entry("kind/second", b"the second answer")
    (home / "kind/first").replace(home / "kind/second")
    assert read_entry("kind/second") is None


@pytest.mark.parametrize("packed", [b"not packed", zlib.compress(b"cut")[:-2], b""], ids=["not packed", "cut", "empty"])
def test_a_signature_that_fits_does_not_make_an_entry(packed: bytes, home: Path) -> None:
    write_entry("kind/name", b"0123456789")
    key = (home.parent / "state" / "cellc" / "cache.key").read_bytes()
    signature = hashlib.blake2b(b"kind/name\0" + packed, key=key, digest_size=32).hexdigest().encode()
    (home / "kind/name").write_bytes(signature + b"\n" + packed)
    assert read_entry("kind/name") is None


def test_an_entry_that_another_key_signed_is_none(home: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # A branch's own job wrote it, and CI restored it for the next one.
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "theirs"))
    write_entry("kind/name", b"no contacts")
    assert read_entry("kind/name") == b"no contacts"
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "ours"))
    assert read_entry("kind/name") is None


def test_a_public_sum_makes_no_entry(home: Path) -> None:
    packed = zlib.compress(b"no contacts", 1)
    write_entry("kind/name", b"0123456789")
    (home / "kind/name").write_bytes(hashlib.sha256(b"kind/name\0" + packed).hexdigest().encode() + b"\n" + packed)
    assert read_entry("kind/name") is None


def test_a_cache_or_key_in_the_working_tree_of_the_spec_is_not_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    tree = tmp_path / "checkout"
    (tree / ".git").mkdir(parents=True)
    (tree / "cells").mkdir()
    spec = tree / "cells" / "cell.yaml"
    write_entry("kind/name", b"0123456789", spec)
    assert read_entry("kind/name", spec) == b"0123456789"  # neither is in it
    for variable in ("XDG_CACHE_HOME", "XDG_STATE_HOME"):
        with monkeypatch.context() as patch:
            patch.setenv(variable, str(tree / ".hidden"))
            write_entry("kind/name", b"0123456789", spec)
            assert read_entry("kind/name", spec) is None
            assert not (tree / ".hidden").exists()


@pytest.mark.parametrize("folder", [".", "kind"])
def test_a_folder_that_others_may_write_is_no_cache(folder: str, home: Path) -> None:
    write_entry("kind/name", b"0123456789")
    (home / folder).chmod(0o770)
    assert read_entry("kind/name") is None
    (home / folder).chmod(0o755)
    assert read_entry("kind/name") == b"0123456789"


def test_the_key_is_for_this_user_alone(home: Path) -> None:
    write_entry("kind/name", b"0123456789")
    key = home.parent / "state" / "cellc" / "cache.key"
    assert key.stat().st_mode & 0o777 == 0o600
    key.chmod(0o640)
    cache_key._key_in.cache_clear()
    assert read_entry("kind/name") is None


def test_without_a_place_for_a_key_nothing_is_kept(home: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    write_entry("kind/name", b"0123456789")
    assert not (home / "kind/name").exists()


def test_a_link_in_the_place_of_an_entry_or_of_its_folder_is_none(home: Path, tmp_path: Path) -> None:
    write_entry("kind/name", b"0123456789")
    (home / "kind/name").rename(tmp_path / "elsewhere")
    (home / "kind/name").symlink_to(tmp_path / "elsewhere")
    assert read_entry("kind/name") is None
    write_entry("kind/name", b"0123456789")
    (home / "kind").rename(tmp_path / "folder")
    (home / "kind").symlink_to(tmp_path / "folder")
    assert read_entry("kind/name") is None


def test_what_unpacks_to_more_than_an_answer_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    write_entry("kind/name", b" " * 1000)
    monkeypatch.setattr(cache, "MAX_CONTENT_BYTES", 500)
    assert read_entry("kind/name") is None


def test_a_pipe_in_the_place_of_an_entry_is_not_waited_for(home: Path) -> None:
    (home / "kind").mkdir(parents=True)
    os.mkfifo(home / "kind/name")
    assert read_entry("kind/name") is None
    write_entry("kind/name", b"0123456789")
    assert read_entry("kind/name") == b"0123456789"


def test_pruning_removes_no_file_of_somebody_else(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    # A restored or shared cache may hold a link in the place of a folder, and files that are no entries.
    photos = tmp_path / "photos"
    photos.mkdir()
    for number in range(30):
        (photos / f"{number}.jpg").touch()
        (photos / f"{number:064x}.json").touch()
    linked = tmp_path / "linked"
    linked.symlink_to(photos)
    monkeypatch.setattr(cache, "MAX_ENTRIES", 10)
    cache._prune(linked)
    assert len(list(photos.iterdir())) == 60
    cache._prune(photos)
    assert len(list(photos.glob("*.jpg"))) == 30
    assert len(list(photos.glob("*.json"))) == 15
