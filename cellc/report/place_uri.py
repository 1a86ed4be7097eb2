"""How reports for other programs name a file: relative to where cellc ran, wherever that is possible."""

from __future__ import annotations

from pathlib import PurePath, PurePosixPath
from urllib.parse import quote


def relative_file(file: str, folder: PurePath) -> str:
    """Return a file relative to ``folder`` where it lies in it, else as it is named; with forward slashes.

    Args:
        file: as spans carry it.
        folder: absolute.
    """
    path = PurePath(file)
    if path.is_absolute() and path.is_relative_to(folder):
        path = path.relative_to(folder)
    return str(PurePosixPath(path.as_posix()))


def file_uri(file: str, folder: PurePath) -> str:
    """Return the URI reference of a file (RFC 3986): relative as by `relative_file`, or with the scheme ``file``."""
    path = PurePath(relative_file(file, folder))
    # A colon in the first segment would begin a scheme (section 4.2), so it is written as an escape like all others.
    return path.as_uri() if path.is_absolute() else quote(path.as_posix())
