"""What has one safe answer: misspelled keys and units, and a missing modeline.

A number without any unit is left alone: each field takes several, and which one was meant only its author knows.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from cellc.contract.diagnostics import Diagnostic, Fix
from cellc.tools.edit.rewrite import Edit


def sure_edits(diagnostics: Iterable[Diagnostic]) -> Iterator[Edit]:
    """Yield the edits of findings that can mean only one thing, and whose line belongs to one place alone."""
    findings = tuple(diagnostics)
    # An alias brings one line into several places, where it may mean different things.
    times = Counter((each.code, each.span) for each in findings)
    taken = set()
    for each in findings:
        if each.fix is None or not each.fix.sure or times[each.code, each.span] > 1:
            continue
        place = (each.code, each.yaml_path[:-1], each.fix.text if each.code == "unknown-key" else each.yaml_path[-1:])
        if place not in taken:
            taken.add(place)
            yield edit_of(each.fix)


def edit_of(fix: Fix) -> Edit:
    """Return a fix as an edit of its file, with what it says to the user."""
    span, message = fix.span, f"`{fix.written}` becomes `{fix.text}`"
    return Edit(span.file, span.line, span.column, span.end_column, fix.text, message)


_MODELINE = "yaml-language-server:"
_SCHEMAS = Path("schemas")


def missing_modeline(file: str, text: str, schema_of: str = "cell") -> Iterator[Edit]:
    """Yield the edit that puts the modeline first, where the file has none and a schema lies beside or above it.

    Args:
        file: the root spec, or the file of a device, as the user named it.
        schema_of: what it is: a cell or a device.
    """
    schema = _schema_above(Path(file), _SCHEMAS / f"{schema_of}.schema.json")
    if schema is None or any(_MODELINE in line for line in text.split("\n") if line.lstrip().startswith("#")):
        return
    line = f"# {_MODELINE} $schema={schema}"
    yield Edit(file, 1, 1, 1, f"{line}\n", f"`{line}` is added")


def _schema_above(file: Path, schema: Path) -> str | None:
    folder = file.resolve().parent
    for above in (folder, *folder.parents):
        if (above / schema).is_file():
            return Path(os.path.relpath(above / schema, folder)).as_posix()
    return None
