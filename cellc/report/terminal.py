"""Text for a terminal: colours, harmless escapes, and the line of a file that a finding marks."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from cellc.diagnostics import Severity, Span

_RESET = "\x1b[0m"
BOLD = "\x1b[1m"
BLUE = "\x1b[1;34m"
GREEN = "\x1b[32m"
SEVERITY_COLOURS: Mapping[Severity, str] = {
    Severity.ERROR: "\x1b[1;31m",
    Severity.BLOCKER: "\x1b[1;35m",
    Severity.WARNING: "\x1b[1;33m",
    Severity.AUDIT: "\x1b[1;36m",
}


class Stream(Protocol):
    """What is asked of an output stream."""

    def isatty(self) -> bool:
        """Whether a person reads it on a terminal."""


def wants_colour(stream: Stream, environment: Mapping[str, str]) -> bool:
    """Return whether to colour what goes to ``stream``.

    NO_COLOR (no-color.org) wins over FORCE_COLOR (force-color.org) and CLICOLOR_FORCE, these over CLICOLOR
    (bixense.com/clicolors); without them a terminal is coloured unless it is dumb.
    """
    if environment.get("NO_COLOR"):
        return False
    for name in ("FORCE_COLOR", "CLICOLOR_FORCE"):
        if environment.get(name, "0") not in ("", "0"):
            return True
    if environment.get("CLICOLOR") == "0" or environment.get("TERM") == "dumb":
        return False
    return stream.isatty()


def paint(text: str, style: str, colour: bool) -> str:
    """Return ``text`` in a style where colour is wanted."""
    return f"{style}{text}{_RESET}" if colour and text else text


# Controls, invisible formatting, lone surrogates, and the separators that some terminals break lines at.
_UNSAFE_CATEGORIES = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


def escape(text: str) -> str:
    """Return ``text`` on one line with every character that could steer a terminal written as an escape."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(escape_character(character) for character in text)


def escape_character(character: str) -> str:
    """Return a character itself, or its escape such as ``\\x1b``."""
    if unicodedata.category(character) not in _UNSAFE_CATEGORIES:
        return character
    return character.encode("unicode_escape").decode("ascii")


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
    return escape_character(character)


def _width(shown: str) -> int:
    return sum(_character_width(character) for character in shown)


def _character_width(character: str) -> int:
    if character.isascii():
        return 1
    if unicodedata.category(character) in ("Mn", "Me"):
        return 0
    return 2 if unicodedata.east_asian_width(character) in ("W", "F") else 1


Lines = Mapping[str, Sequence[str]]
"""The lines of every file, by the name that spans carry."""


def render_snippet(span: Span, lines: Lines, *, gutter: int, mark: str, style: str, colour: bool) -> list[str]:
    """Return the lines of output for one place; a file whose text is not at hand is only named.

    Args:
        gutter: digits of the widest line number of the finding.
        mark: the character under the culprit, ``^`` or ``-``.
    """
    arrow = paint("-->", BLUE, colour)
    shown = [f"{' ' * gutter}{arrow} {escape(str(span))}"]
    file = lines.get(span.file, ())
    if not 1 <= span.line <= len(file):
        return shown
    line = file[span.line - 1]
    end = span.end_column - 1 if span.end_line == span.line else len(line)
    part = excerpt(line, span.column - 1, end)
    bar = paint("|", BLUE, colour)
    number = paint(f"{span.line:>{gutter}}", BLUE, colour)
    carets = paint(mark * part.marked_cells, style, colour)
    shown.append(f"{' ' * gutter} {bar}")
    shown.append(f"{number} {bar} {part.text}".rstrip())
    shown.append(f"{' ' * gutter} {bar} {' ' * part.marked_from}{carets}")
    return shown
