"""The file that attempt records are written to."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from cellc.contract.attempt import AttemptRecord
from cellc.contract.errors import reason_of
from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.swap import open_stream, replace_whole
from cellc.mock.errors import MockError
from cellc.mock.result import to_json_lines

_LONGEST_RECORD = 1 << 20


def write_records(path: Path, records: Iterable[AttemptRecord]) -> None:
    """Write a file of records whole or not at all; a pipe or a device such as ``/dev/stdout`` is written to.

    Raises:
        MockError: the file cannot be written, or what is there is a link or no file of records.
    """
    refuse_foreign(path)
    content = to_json_lines(records).encode()
    try:
        if _is_stream(path) or (path.exists() and not path.is_file()):
            with _opened(path) as stream:
                stream.write(content)
        else:
            replace_whole(path, content)
    except OSError as error:
        raise MockError(path.as_posix(), f"cannot be written: {reason_of(error)}") from None


def refuse_foreign(path: Path) -> None:
    """Raise MockError where a link is at the path of the records, or a file that holds something else."""
    if _is_stream(path):
        return
    if path.is_symlink():
        raise MockError(path.as_posix(), "is a symbolic link; name the file itself")
    if path.is_file() and not _holds_records(path):
        raise MockError(path.as_posix(), "is no file of records; move it away, or name another file")


def _opened(path: Path) -> BinaryIO:
    """Open a stream by its path; one that is open already goes on where it is, though it be a file."""
    name = {"stdout": "1", "stderr": "2"}.get(path.name, path.name)
    return open_stream(int(name) if _is_stream(path) and name.isdigit() else path)


def _is_stream(path: Path) -> bool:
    """Whether the path is one that the system gives to an open stream, as a link in most cases."""
    return Path(os.path.abspath(path)).parent.as_posix() in ("/dev", "/dev/fd", "/proc/self/fd")


def _holds_records(path: Path) -> bool:
    """Whether the file is empty, or begins with an attempt."""
    try:
        with open_regular(path) as stream:
            line = stream.readline(_LONGEST_RECORD)
        return not line or (line.endswith(b"\n") and "attempt_id" in json.loads(line))
    except (OSError, ValueError, TypeError, RecursionError):
        return False
