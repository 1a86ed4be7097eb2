"""The line of a file that a finding marks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.diagnostics import Span
from cellc.contract.diagnostics.unsafe_text import escaped_character
from cellc.contract.folding import LEAST, cells
from cellc.contract.printing import Line, Style, Styled, columns

_TAB_STOP = 4
WIDEST = 110
_CONTEXT = 24
_CUT = "..."


@dataclass(frozen=True, slots=True)
class Excerpt:
    """One line as shown: its text, and the marked part in terminal cells."""

    text: str
    marked_from: int
    marked_cells: int


def excerpt(line: str, start: int, end: int, widest: int = WIDEST) -> Excerpt:
    """Return the visible part of ``line`` with the characters ``start`` to ``end`` marked.

    Tabs become spaces, control characters escapes; wide characters count two cells and combining ones none. A long line
    is cut to a window around the marked part, which is at least one cell wide.

    Args:
        start: index of the first marked character; behind the line for its end.
        end: index after the last marked character.
        widest: cells that are shown, beside the signs of a cut.
    """
    first = _window_start(line, start, widest)
    pieces, offset = [_CUT] if first else [], len(_CUT) if first else 0
    marked_from = marked_until = None
    for index in range(first, len(line)):
        shown = _shown(line[index], offset)
        width = cells(shown)
        if offset + width > widest:
            pieces.append(_CUT)
            break
        marked_from = offset if index == start else marked_from
        offset += width
        marked_until = offset if index < end else marked_until
        pieces.append(shown)
    begin = marked_from if marked_from is not None else offset
    return Excerpt("".join(pieces).rstrip(), begin, max(1, (marked_until or 0) - begin))


def _window_start(line: str, start: int, widest: int) -> int:
    """Return the index at which the window begins: the start of the line where the culprit fits without a cut."""
    start = min(start, len(line))
    # No character but an escaped one is wider than two cells, so half the width always fits.
    return 0 if start <= widest // 2 else start - min(_CONTEXT, widest // 4)


def _shown(character: str, offset: int) -> str:
    if character == "\t":
        return " " * (_TAB_STOP - offset % _TAB_STOP)
    return escaped_character(character)


def _room(gutter: int) -> int:
    """Return the cells of a line behind its number and bar, and before the sign of a cut."""
    beside = gutter + len(" | ") + len(_CUT)
    return min(WIDEST, max(columns(WIDEST + beside), LEAST) - beside)


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
    part = excerpt(line, span.column - 1, end, _room(gutter))
    carets = Styled(mark * part.marked_cells, style)
    shown.append((f"{margin} ", bar))
    shown.append((Styled(f"{span.line:>{gutter}}", Style.BLUE), " ", bar, f" {part.text}".rstrip()))
    shown.append((f"{margin} ", bar, f" {' ' * part.marked_from}", carets))
    return shown
