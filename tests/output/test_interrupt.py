"""Ctrl-C on any line and a kill at any replacement leave a whole folder, or one that the next build heals."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import cellc.compiler.output
from cellc.compiler.output.write import write
from cellc.contract.store import staging as stagings
from tests.output.building import as_contents, build_of, contents, staging_at_work

FIRST = build_of(a_txt="one\n", b_txt="two\n", old__d_txt="d\n")
SECOND = build_of(a_txt="changed\n", b_txt="two\n", new__e_txt="e\n")
THIRD = build_of(a_txt="again\n", b_txt="2\n", new__e_txt="e2\n")
_STAGE = str(Path(cellc.compiler.output.__file__).parent)


class _Killed(BaseException):
    """Stands for a process that ends without running another line."""


def _interrupt_at(line: int, act: Callable[[], object]) -> bool:
    """Run ``act`` and press Ctrl-C before the given line of the output stage; return whether it had so many."""
    seen = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal seen
        if not frame.f_code.co_filename.startswith(_STAGE):
            return None
        if event == "line":
            seen += 1
            if seen == line:
                raise KeyboardInterrupt
        return trace

    sys.settrace(trace)
    try:
        act()
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(None)
    return False


@pytest.mark.parametrize("start", [None, FIRST], ids=["first build", "next build"])
def test_interrupt_on_any_line_leaves_the_old_or_the_new_folder(start: Any, tmp_path: Path) -> None:
    line, both = 0, set()
    was_interrupted = True
    while was_interrupted:
        line += 1
        place = tmp_path / str(line)
        place.mkdir()
        if start:
            write(start, place / "generated/small")
        old, new = contents(place), {f"generated/small/{path}": text for path, text in as_contents(SECOND).items()}
        was_interrupted = _interrupt_at(line, partial(write, SECOND, place / "generated/small"))
        left = contents(place)
        assert _but_empty_folders(left) in (old, new), line
        both.add(left == old)
    assert line > 100
    assert both == {True, False}


def _but_empty_folders(left: dict[str, str]) -> dict[str, str]:
    # Emptied folders are removed last; one that an interrupt spares harms nobody.
    return {path: text for path, text in left.items() if not path.endswith("/")}


@pytest.mark.parametrize("replacement", [1, 2, 3])
def test_build_after_a_kill_heals_the_folder(replacement: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    _kill_at(replacement, folder, monkeypatch)
    assert any(path.name.startswith(".small.tmp-") for path in tmp_path.iterdir())
    assert write(THIRD, folder).ok
    assert contents(tmp_path) == {f"small/{path}": text for path, text in as_contents(THIRD).items()}


def test_edit_after_a_kill_is_still_an_edit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "small"
    write(FIRST, folder)
    _kill_at(2, folder, monkeypatch)
    (folder / "a.txt").write_text("mine\n")
    assert [d.code for d in write(THIRD, folder).diagnostics] == ["edited-by-hand"]


def test_folder_that_another_build_is_writing_is_left_alone(tmp_path: Path) -> None:
    staging_at_work(tmp_path / ".small.tmp-1")
    assert [d.code for d in write(FIRST, tmp_path / "small").diagnostics] == ["output-busy"]
    assert contents(tmp_path) == {".small.tmp-1/.cellc-lock": ""}


def _let_go(staging: Path) -> None:
    """Do with the lock of a staging folder what the system does when its process ends, and no more."""
    lock = stagings._locks.pop(staging, None)
    if lock is not None:
        lock.close()


def _kill_at(replacement: int, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stop a build right before one of its replacements, with nothing of it cleaned up."""
    real, calls = os.replace, [0]

    def replace(source: Path, target: Path) -> None:
        calls[0] += 1
        if calls[0] == replacement:
            raise _Killed
        real(source, target)

    monkeypatch.setattr(os, "replace", replace)
    monkeypatch.setattr("cellc.contract.store.swap.Swap.undo", lambda _: None)
    monkeypatch.setattr("cellc.compiler.output.write.discard", _let_go)
    # No process has this number: it is above the largest that Linux gives out.
    monkeypatch.setattr("os.getpid", lambda: 2**22 + 1)
    with pytest.raises(_Killed):
        write(SECOND, folder)
    monkeypatch.undo()
