"""What the options of the command ask for, which of them contradict each other, and files that a run writes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from cellc.mock.errors import MockError


def contradiction(
    *, rehearsals: bool, modes: Mapping[str, bool], pairs: bool, jobs: bool, paths: Mapping[str, str | None]
) -> str:
    """Say which options do not go together; empty where all do.

    Args:
        rehearsals: declared rehearsals were named.
        modes: what else to do than to run rehearsals, by option, and whether it was asked for.
        pairs: runs with two faults were asked for.
        jobs: a number of processes was asked for.
        paths: files and folders to write, by option.
    """
    asked = [option for option, given in modes.items() if given]
    alone = [option for option in asked if option != "--campaign"]
    if rehearsals and asked:
        return "--rehearsal does not go with the options of the campaign"
    if len(alone) > 1:
        return f"{alone[0]} does not go with {alone[1]}"
    if (pairs or jobs) and not asked:
        return f"{'--pairs' if pairs else '--jobs'} needs --campaign"
    written = [option for option, path in paths.items() if path is not None]
    if "--list" in alone and written:
        return f"{written[0]} does not go with --list, which runs nothing"
    empty = [option for option, path in paths.items() if path == ""]
    return f"{empty[0]} cannot be written: its path is empty" if empty else ""


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
