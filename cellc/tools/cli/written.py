"""Reports that a command writes into a folder of the user, where files of others stay as they are."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import click

from cellc.contract.errors import reason_of
from cellc.contract.printing import refuse

_HEAD = 1024
"""Bytes in which a file of the command has its mark, which those of others have not."""


def write_reports(output: Path, texts: Mapping[str, tuple[str, str]]) -> None:
    """Write files by their name, each with the mark by which the command knows its own; all or none.

    Raises:
        click.exceptions.Exit: a file is of others, or cannot be written; nothing was written before the first is.
    """
    from cellc.contract.store.swap import make_folder, replace_whole

    try:
        make_folder(output)
        for name, (_, mark) in texts.items():
            _hold_own(output / name, mark.encode())
        for name, (text, _) in texts.items():
            replace_whole(output / name, text.encode())
    except OSError as error:
        refuse(f"{output.as_posix()}: cannot be written: {reason_of(error)}")
        raise click.exceptions.Exit(2) from None


def _hold_own(place: Path, mark: bytes) -> None:
    """Refuse to replace what the command did not write."""
    from cellc.contract.store.regular_file import open_regular

    try:
        with open_regular(place, follow=False) as stream:
            is_own = mark in stream.read(_HEAD)
    except FileNotFoundError:
        return
    if not is_own:
        refuse(f"{place.as_posix()}: is no file of this command; move it away, or name another folder")
        raise click.exceptions.Exit(2)
