"""The line of a file that a finding marks."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.diagnostics import Span
from cellc.contract.diagnostics.unsafe_text import escaped_character
from cellc.contract.printing import Line, Style, Styled

_TAB_STOP = 4
_WIDEST = 110
_CONTEXT = 24
_CUT = "..."


@dataclass(frozen=True, slots=True)
class Excerpt:
    """One line as shown: its text, and the marked part in terminal cells."""

    text: str
    marked_from: int
    marked_cells: int


def excerpt(line: str, start: int, end: int) -> Excerpt:
    """Return the visible part of ``line`` with the characters ``start`` to ``end`` marked.

    Tabs become spaces, control characters escapes; wide characters count two cells and combining ones none. A long line
    is cut to a window around the marked part, which is at least one cell wide.

    Args:
        start: index of the first marked character; behind the line for its end.
        end: index after the last marked character.
    """
    first = _window_start(line, start)
    cells, offset = [_CUT] if first else [], len(_CUT) if first else 0
    marked_from = marked_until = None
    for index in range(first, len(line)):
        shown = _shown(line[index], offset)
        width = _width(shown)
        if offset + width > _WIDEST:
            cells.append(_CUT)
            break
        marked_from = offset if index == start else marked_from
        offset += width
        marked_until = offset if index < end else marked_until
        cells.append(shown)
    begin = marked_from if marked_from is not None else offset
    return Excerpt("".join(cells).rstrip(), begin, max(1, (marked_until or 0) - begin))


def _window_start(line: str, start: int) -> int:
    """Return the index at which the window begins: the start of the line where the culprit fits without a cut."""
    start = min(start, len(line))
    # No character but an escaped one is wider than two cells, so half the width always fits.
    return 0 if start <= _WIDEST // 2 else start - _CONTEXT


def _shown(character: str, offset: int) -> str:
    if character == "\t":
        return " " * (_TAB_STOP - offset % _TAB_STOP)
    return escaped_character(character)


def _width(shown: str) -> int:
    return sum(_character_width(character) for character in shown)


def _character_width(character: str) -> int:
    if character.isascii():
        return 1
    if unicodedata.category(character) in ("Mn", "Me"):
        return 0
    return 2 if unicodedata.east_asian_width(character) in ("W", "F") else 1


Texts = Mapping[str, Sequence[str]]
"""The lines of every file, by the name that spans carry."""


def render_snippet(span: Span, texts: Texts, *, gutter: int, mark: str, style: Style) -> list[Line]:
    """Return the lines of output for one place; a file whose text is not at hand is only named.

    Args:
        gutter: digits of the widest line number of the finding.
        mark: the character under the culprit, ``^`` or ``-``.
    """
    margin, bar = " " * gutter, Styled("|", Style.BLUE)
    shown: list[Line] = [(margin, Styled("-->", Style.BLUE), f" {span}")]
    file = texts.get(span.file, ())
    if not 1 <= span.line <= len(file):
        return shown
    line = file[span.line - 1]
    end = span.end_column - 1 if span.end_line == span.line else len(line)
    part = excerpt(line, span.column - 1, end)
    carets = Styled(mark * part.marked_cells, style)
    shown.append((f"{margin} ", bar))
    shown.append((Styled(f"{span.line:>{gutter}}", Style.BLUE), " ", bar, f" {part.text}".rstrip()))
    shown.append((f"{margin} ", bar, f" {' ' * part.marked_from}", carets))
    return shown
