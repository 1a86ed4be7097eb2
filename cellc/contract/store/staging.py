"""Staging folders: where a process makes ready what replaces a folder, beside it, and how it tells others that it does.

A staging folder is called ``.<name>.tmp-<run>-<process>``, and a lock in it is held as long as its process runs. One
whose lock is free was left by a killed process; it still holds what that process was about to write.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import stat
import sys
from pathlib import Path
from typing import BinaryIO

from cellc.contract.store.regular_file import open_regular

if sys.platform != "win32":
    import fcntl

_MAKER = re.compile("(?:[0-9a-f]{8}-)?[0-9]{1,10}")
_RUN = os.urandom(4).hex()
"""Tells this run from a killed one whose process had the same number, as every run in a container has."""
_LOCK = ".cellc-lock"
"""A file in a staging folder that is locked as long as its maker runs: what no archive and no repository can carry."""
_NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
_locks: dict[Path, BinaryIO] = {}
"""The locks that this process holds, by their staging folders."""


def staging_of(folder: Path) -> Path:
    """Return where this process makes ready what shall stand in the place of a folder or file."""
    return folder.parent / f".{folder.name}.tmp-{_RUN}-{os.getpid()}"


def make_staging(folder: Path) -> Path:
    """Make the staging folder of this process, marked as made by cellc, and locked until it is discarded.

    Raises:
        BlockingIOError: another process took it for one of a killed process before it had its lock.
        OSError: something is there, or writing is refused.
    """
    staging = staging_of(folder)
    os.mkdir(staging, 0o1777)
    lock = _locked(staging, wait=True)
    if lock is None:
        raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), str(staging))
    _locks[staging] = lock
    return staging


def _locked(staging: Path, *, wait: bool = False) -> BinaryIO | None:
    """Lock a staging folder; None where another process has its lock, or has removed it meanwhile."""
    place = staging / _LOCK
    try:
        lock = os.fdopen(os.open(place, os.O_RDWR | os.O_CREAT | _NO_LINK, 0o666), "r+b", buffering=0)
    except FileNotFoundError:
        return None
    if sys.platform == "win32":
        return lock
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        lock.close()
        return None
    except OSError:  # a file system without locks: processes there do not see each other
        return lock
    with contextlib.suppress(FileNotFoundError):
        if os.path.samestat(place.lstat(), os.fstat(lock.fileno())):
            return lock
    lock.close()
    return None


def contested(folder: Path) -> bool:
    """Whether another process that runs is making files ready for the same folder.

    A process that made its staging folder asks a second time: of two processes, the one that asks later sees the other.
    On a file system without locks a staging folder passes for that of a killed process, and may have been removed.
    """
    own_staging = staging_of(folder)
    overtaken = own_staging in _locks and not _is_staging(own_staging)
    return overtaken or any(is_alive(staging) for staging in others(folder))


def others(folder: Path) -> tuple[Path, ...]:
    """Return staging folders that other processes made for the same folder.

    A folder from a checkout is not counted: it would pass edits of a person off as those of a killed build. The
    mark is the sticky bit, which git stores of no folder, and which Linux sets as it makes one (mkdir(2)); other
    systems do not, and all count there.
    """
    staging = staging_of(folder)
    return tuple(path for path in temporaries(folder) if path != staging and _is_staging(path))


def _is_staging(path: Path) -> bool:
    try:
        mode = path.lstat().st_mode
    except FileNotFoundError:  # its process has discarded it
        return False
    return stat.S_ISDIR(mode) and (sys.platform != "linux" or bool(mode & stat.S_ISVTX))


def is_alive(staging: Path) -> bool:
    """Whether the process that made the staging folder still runs: it holds the lock in it."""
    if sys.platform == "win32":
        return False
    try:
        with open_regular(staging / _LOCK, follow=False) as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # no lock, or a file system without locks
        return False
    return False


def discard(staging: Path) -> None:
    """Remove the staging folder of this process, or of a killed one, as far as the system lets; its lock goes last."""
    lock = _locks.pop(staging, None)
    with contextlib.suppress(OSError):
        lock = lock or _locked(staging)
        if lock is None:
            return  # a process at work has it by now
        for path in tuple(staging.iterdir()):
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            elif path.name != _LOCK:
                path.unlink()
    shutil.rmtree(staging, ignore_errors=True)
    if lock is not None:
        lock.close()


def temporaries(path: Path) -> tuple[Path, ...]:
    """Return what processes made beside a file or folder to put it in place; names of another form are somebody's."""
    prefix = f".{path.name}.tmp-"
    hidden = (item for item in path.parent.glob(".*") if item.name.startswith(prefix))
    return tuple(sorted(item for item in hidden if _MAKER.fullmatch(item.name[len(prefix) :])))


def runs(part: Path) -> bool:
    """Whether there is a process of the number that the name of a temporary file has."""
    number = part.name.rpartition("-")[2]
    if os.name != "posix" or int(number) in (0, os.getpid()):
        return False
    try:
        os.kill(int(number), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True
