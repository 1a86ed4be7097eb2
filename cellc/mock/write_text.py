"""Writes what a run leaves to a file."""

from __future__ import annotations

import os
from pathlib import Path

from cellc.mock.errors import MockError


def write_text(path: Path, text: str) -> None:
    """Write a file whole or not at all; a pipe or a device such as ``/dev/stdout`` is written to, not replaced.

    Raises:
        MockError: the file cannot be written.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(text.encode())
        else:
            _replace(Path(os.path.realpath(path)), text)
    except OSError as error:
        raise MockError(path.as_posix(), f"cannot be written: {(error.strerror or 'unknown reason').lower()}") from None


def _replace(path: Path, text: str) -> None:
    part = path.with_name(f".{path.name}.part")
    try:
        part.write_bytes(text.encode())
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
