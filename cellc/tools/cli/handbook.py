"""Pages of cellc in a folder, and no one else's replaced: a README.md is what other people's folders have too."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import click

from cellc.contract.store.regular_file import open_regular
from cellc.contract.store.swap import write_whole


def write_pages(folder: Path, pages: Mapping[str, str]) -> None:
    """Write pages by their names into a folder.

    Raises:
        UsageError: a file of another title is in the place of one; nothing is written then.
        OSError: writing is refused.
    """
    for name, text in pages.items():
        file = folder / name
        if file.is_file() and _title(file) not in ("", text.partition("\n")[0].partition(" (")[0]):
            raise click.UsageError(f"`{file.as_posix()}` is not a page that cellc wrote: name another folder")
    for name, text in pages.items():
        write_whole(folder / name, text)


def _title(file: Path) -> str:
    """Return the first line; another release may give a code another severity, which is in brackets."""
    with open_regular(file) as stream:
        return stream.readline().decode(errors="replace").rstrip("\r\n").partition(" (")[0]
