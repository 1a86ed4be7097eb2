"""The option by which ``cellc check`` mends what has one safe answer."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.report.escape import escape

if TYPE_CHECKING:
    from cellc.edit.edit import Edit

FIX = click.option(
    "--fix",
    is_flag=True,
    help="Mend what has one safe answer in the files: misspelt keys and units, the modeline.",
)
# A mended key can show a misspelt one below it; no spec is nested deeper.
_PASSES = 16


def fix_file(file: str) -> None:
    """Mend a spec and what it includes, and say on standard error what was done."""
    from cellc.edit.keys import misspelt_keys
    from cellc.edit.modeline import missing_modeline
    from cellc.edit.units import misspelt_units
    from cellc.pipeline import check
    from cellc.source import read

    for _ in range(_PASSES):
        document = read(file)
        if document.value is None or not document.ok:
            return
        found = check(file).diagnostics
        edits: list[Edit] = [*misspelt_keys(found, document.value), *misspelt_units(found, document.value)]
        edits += missing_modeline(document.value.file, document.value.texts[document.value.file])
        if not edits:
            return
        for name, group in groupby(sorted(edits, key=lambda one: (one.file, one.line)), key=lambda one: one.file):
            _rewrite(name, list(group), document.value.texts[name])


def _rewrite(file: str, edits: Sequence[Edit], text: str) -> None:
    from cellc.edit.rewrite import rewrite

    try:
        done = rewrite(Path(file), edits, text)
    except OSError as error:
        raise click.UsageError(f"`{file}` cannot be written: {(error.strerror or 'unknown reason').lower()}") from error
    for edit in edits if done else ():
        click.echo(f"{escape(edit.file)}:{edit.line}: {escape(edit.message)}", err=True)
