"""Lines as a terminal shows them: one that is too wide goes on below itself, at a blank."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence

LEAST = 40
"""Columns below which nothing is folded any further."""
_WORD = re.compile(r"(?:`[^`]*`|(?<=\d) (?=[A-Za-z%]{1,3}\b)|\S)+")
"""What stays whole: a word, a number with its unit, or what is in backticks, which is copied."""
_SIGN = re.compile(r" *(?:[-*] |\d+\. )?")
_COLUMN = re.compile(r"(?<=\S)  +(?=\S)")

Piece = tuple[str, str]
"""A text, and the escape sequence that it follows; empty for none."""


def cells(text: str) -> int:
    """Return how many cells of a terminal a text takes: wide characters take two, combining ones none."""
    return len(text) if text.isascii() else sum(map(_cells_of, text))


def _cells_of(character: str) -> int:
    if unicodedata.category(character) in ("Mn", "Me"):
        return 0
    return 2 if unicodedata.east_asian_width(character) in ("W", "F") else 1


def folded(pieces: Sequence[Piece], wide: int) -> Iterator[Sequence[Piece]]:
    """Yield the pieces of each line of the terminal; what goes on is below the last column of its line.

    Args:
        wide: columns; a longer word is left whole, so that it can be copied. Zero for no end of a line.
    """
    text = "".join(piece for piece, _ in pieces)
    if not wide or cells(text) <= wide:
        yield pieces
        return
    hang = _hang(text, wide)
    for number, (start, end) in enumerate(_lines(text, wide, hang)):
        yield [(" " * (hang if number else 0), ""), *_part(pieces, start, end)]


def _hang(text: str, wide: int) -> int:
    """Return where a line goes on: below its last column that leaves half of the width, else behind its indent."""
    longest = max((cells(word) for word in _WORD.findall(text)), default=0)
    most = min(wide // 2 + 2, wide - longest if longest < wide else wide)
    starts = [found.end() for found in _COLUMN.finditer(text) if found.end() <= most]
    sign = _SIGN.match(text)
    indent = sign.end() if sign else 0
    return starts[-1] if starts else indent + (2 if text[:indent].isspace() or not indent else 0)


def _lines(text: str, wide: int, hang: int) -> Iterator[tuple[int, int]]:
    start = end = 0
    for word in _WORD.finditer(text):
        room = wide - (hang if start else 0)
        # A runner takes a line that begins with two colons for a command.
        if end and cells(text[start : word.end()]) > room and not word[0].startswith("::"):
            yield start, end
            start = word.start()
        end = word.end()
    yield start, end


def _part(pieces: Sequence[Piece], start: int, end: int) -> Iterator[Piece]:
    at = 0
    for text, style in pieces:
        piece = text[max(start - at, 0) : max(end - at, 0)]
        if piece:
            yield piece, style
        at += len(text)
