"""What can be asked of the disk. Paths count from the current folder, which is part of whatever is kept."""

from __future__ import annotations

import glob
import hashlib
import os
import stat
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeVar

from cellc.disk.record import Question, record_in_work

Path = str | os.PathLike[str]
Kind = Literal["file", "folder", "other"]

_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class Status:
    """What stands at a path, links followed, and its size in bytes."""

    kind: Kind
    size: int


def status(path: Path) -> Status:
    """Return what stands at a path.

    Raises:
        OSError: nothing does, or it may not be known.
        ValueError: the path holds a zero character.
    """
    return _asked(("status", os.fspath(path), 0), lambda: _status(path), lambda found: f"{found.kind} {found.size}")


def kind_of(path: Path) -> Kind | Literal["absent"]:
    """Return what stands at a path; "absent" too where it may not be known."""
    try:
        return status(path).kind
    except (OSError, ValueError):
        return "absent"


def contents(path: Path, most: int) -> bytes:
    """Return the bytes of a file, but no more than ``most`` and one, by which one shows that is too large.

    Raises:
        OSError: it cannot be read.
        ValueError: the path holds a zero character.
    """
    return _asked(("contents", os.fspath(path), most), lambda: _contents(path, most), _digest)


def real_path(path: Path) -> str:
    """Return the absolute path without links; a link that leads to itself stays.

    Raises:
        OSError: the system refuses.
        ValueError: the path holds a zero character.
    """
    return _asked(("real path", os.fspath(path), 0), lambda: os.path.realpath(path), str)


def names_in(folder: Path) -> list[str]:
    """Return the names in a folder, sorted.

    Raises:
        OSError: it is no folder, or cannot be listed.
    """
    return _asked(("names", os.fspath(folder), 0), lambda: sorted(os.listdir(folder)), _digest_of_names)


def matches(pattern: str) -> list[str]:
    """Return the paths that fit a pattern of the shell, sorted."""
    return _asked(("matches", pattern, 0), lambda: sorted(glob.glob(pattern)), _digest_of_names)


ASK: dict[str, Callable[[str, int], object]] = {
    "status": lambda path, _limit: status(path),
    "contents": contents,
    "real path": lambda path, _limit: real_path(path),
    "names": lambda path, _limit: names_in(path),
    "matches": lambda path, _limit: matches(path),
}
"""How to ask a question again that was written down."""


def _asked(question: Question, ask: Callable[[], _T], mark: Callable[[_T], str]) -> _T:
    record = record_in_work()
    try:
        answer = ask()
    except (OSError, ValueError) as error:
        if record is not None:
            record.note(question, f"{type(error).__name__} {getattr(error, 'errno', None)}")
        raise
    if record is not None:
        record.note(question, mark(answer))
    return answer


def _status(path: Path) -> Status:
    found = os.stat(path)
    if stat.S_ISREG(found.st_mode):
        return Status("file", found.st_size)
    return Status("folder" if stat.S_ISDIR(found.st_mode) else "other", 0)


def _contents(path: Path, most: int) -> bytes:
    with open(path, "rb") as file:
        return file.read(most + 1)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _digest_of_names(names: list[str]) -> str:
    return _digest("\0".join(names).encode("utf-8", "surrogateescape"))
