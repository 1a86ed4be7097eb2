"""Which program answers: its files as they stand, and what they run on."""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
_DISTRIBUTIONS = (".dist-info", ".egg-info")


def program_mark(package: Path = PACKAGE, search_path: Sequence[str] | None = None) -> str | None:
    """Return a mark that another version of any file of cellc, of Python or of an installed library changes.

    It is taken before the code is loaded that answers, so that nobody who edits a checkout meanwhile has an answer
    of the old code kept under the mark of the new. Files are known by size and times: the time of change cannot be
    set back, so that a copy which preserves the time of modification is noticed too. Libraries are known by the
    versions in their metadata; who edits one in its place turns the cache off.

    Returns:
        None where the files cannot be seen, such as in an archive.
    """
    try:
        files = sorted(_files(str(package), ""))
        libraries = sorted(_libraries(sys.path if search_path is None else search_path))
    except OSError:
        return None
    runs_on = [sys.version, sys.platform, str(sys.flags.optimize), str(package)]
    return hashlib.sha256("\0".join((*runs_on, *files, *libraries)).encode("utf-8", "surrogateescape")).hexdigest()


def _files(folder: str, inside: str) -> Iterator[str]:
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.is_dir():
                if entry.name != "__pycache__":
                    yield from _files(entry.path, f"{inside}{entry.name}/")
                continue
            found = entry.stat()
            yield f"{inside}{entry.name} {found.st_size} {found.st_mtime_ns} {found.st_ctime_ns}"


def _libraries(search_path: Sequence[str]) -> Iterator[str]:
    for folder in search_path:
        if folder and os.path.isdir(folder):
            yield from (name for name in os.listdir(folder) if name.endswith(_DISTRIBUTIONS))
