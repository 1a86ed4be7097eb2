"""The comments of a YAML text that hold a given marker."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import yaml

_FAST = getattr(yaml, "CLoader", None)
_BLOCK_STYLES = ("|", ">")


@dataclass(frozen=True, slots=True)
class Comment:
    """One comment from its ``#`` to the end of its line; line and column count from 1."""

    line: int
    column: int
    text: str


def comments(text: str, marker: re.Pattern[str], *, pure: bool = False) -> tuple[Comment, ...]:
    """Return the comments in which ``marker`` begins, each from there on.

    The scanner says what is a comment: a ``#`` inside a quoted text or a block of text is none. The text is scanned
    only where the marker occurs at all, so that a file without one costs nothing.

    Args:
        text: valid YAML with line breaks as ``\\n``.
        marker: matches from a ``#`` on, within one line.
        pure: use the scanner written in Python; both give the same comments.
    """
    candidates = [(number, match) for number, line in enumerate(text.split("\n")) for match in marker.finditer(line)]
    if not candidates:
        return ()
    scalars = list(_scalars(text, pure))
    return tuple(
        Comment(line + 1, match.start() + 1, match.string[match.start() :].rstrip())
        for line, match in candidates
        if not any(start <= (line, match.start()) < end for start, end in scalars)
    )


def _scalars(text: str, pure: bool) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield the range of every scalar as line and column from 0, the end exclusive."""
    loader = yaml.Loader if pure or _FAST is None else _FAST
    for token in yaml.scan(text, Loader=loader):
        if isinstance(token, yaml.ScalarToken):
            # A comment may follow the indicator of a block on its own line; the content begins below.
            is_block = token.style in _BLOCK_STYLES
            start = (token.start_mark.line + 1, 0) if is_block else (token.start_mark.line, token.start_mark.column)
            yield start, (token.end_mark.line, token.end_mark.column)
