"""The steps of a swap one by one: folders that are made and go again, and a staging folder whose lock goes last."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.contract.store.staging import discard, make_staging
from cellc.contract.store.swap import Swap


def _swap(tmp_path: Path) -> Swap:
    folder = tmp_path / "out"
    staging = make_staging(folder)
    (staging / "new" / "a" / "b").mkdir(parents=True)
    (staging / "new" / "a" / "b" / "c.txt").write_text("new\n")
    return Swap(folder, staging)


def test_folders_above_a_new_file_are_made_and_go_again(tmp_path: Path) -> None:
    swap = _swap(tmp_path)
    swap.put("a/b/c.txt")
    assert (tmp_path / "out/a/b/c.txt").read_text() == "new\n"
    swap.undo()
    assert list(tmp_path.iterdir()) == []


def test_folder_that_was_there_and_what_is_in_it_stay(tmp_path: Path) -> None:
    (tmp_path / "out" / "a").mkdir(parents=True)
    (tmp_path / "out" / "a" / "own.txt").write_text("own\n")
    swap = _swap(tmp_path)
    swap.make_folder(tmp_path / "out" / "a" / "b" / "d")
    swap.put("a/b/c.txt")
    (tmp_path / "out" / "a" / "b" / "d" / "somebody.txt").write_text("mine\n")
    swap.undo()
    left = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert left == {"out/a/own.txt", "out/a/b/d/somebody.txt"}


def test_lock_of_a_staging_folder_goes_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As long as anything is in it, others see that its process runs."""
    staging = make_staging(tmp_path / "out")
    (staging / "new").mkdir()
    (staging / "new" / "a.txt").touch()
    (staging / "record.txt").touch()
    before_it_goes = []

    def removed(folder: Path, *, ignore_errors: bool = False) -> None:
        if folder == staging:
            before_it_goes.append([path.name for path in staging.iterdir()])
        remove(folder, ignore_errors=ignore_errors)

    remove = shutil.rmtree
    monkeypatch.setattr(shutil, "rmtree", removed)
    discard(staging)
    assert before_it_goes == [[".cellc-lock"]]
    assert not staging.exists()
