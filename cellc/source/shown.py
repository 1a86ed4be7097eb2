"""The texts of files that findings point into, so that a report can show the line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from cellc.diagnostics import Diagnostic
from cellc.source.limits import MAX_FILE_BYTES
from cellc.source.text import showable

_PACKAGE = "cellc/"
"""Spans in the package's own data begin so; they name no file of the current folder."""


def with_shown_texts(texts: Mapping[str, str], found: Iterable[Diagnostic]) -> dict[str, str]:
    """Add the files of devices and descriptions that findings point into; one that cannot be shown is left out.

    Args:
        texts: of the spec and what it includes, by the name that spans carry.
    """
    named = {span.file for one in found for span in (one.span, *(other.span for other in one.related))}
    missing = sorted(name for name in named if name and name not in texts and not name.startswith(_PACKAGE))
    added = {name: text for name in missing if (text := _text(name)) is not None}
    return {**texts, **added}


def _text(name: str) -> str | None:
    try:
        with open(name, "rb") as file:
            content = file.read(MAX_FILE_BYTES + 1)
    except (OSError, ValueError):
        return None
    return None if len(content) > MAX_FILE_BYTES else showable(content)
