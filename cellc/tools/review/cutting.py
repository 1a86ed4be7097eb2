"""Lines as wide as a terminal: broken or cut between words, never in a quantity, nor between the two of a change."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence

from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.diagnostics.wording import count
from cellc.tools.review.tokens import UNITS

WIDTH = 80
_GLUE = "\u00a0"
_FIGURE = re.compile(r"[(+-]*[0-9][0-9.]*(?:e[+-]?[0-9]+)?")
_UNIT = re.compile(r"([A-Za-z%]+)(?:/[a-z]+(?:\^[0-9])?)?[),;:]*")
_OWN_UNITS = ("points", "N")
_OF_NEWTONS = re.compile(r"m(?:\*s)?(?:/rad|/m)?[),;:]*")
_ARROW = "->"
_AT_END = re.compile(r"[0-9.eE+-]*$")


def broken(text: str, indent: str, width: int = WIDTH) -> list[str]:
    """Break a text between words, so that no line is wider than the terminal; a longer word is cut."""
    shown = escaped(text)
    start = shown[: len(shown) - len(shown.lstrip(" "))]
    lines = textwrap.wrap(
        " ".join(piece.replace(" ", _GLUE) for piece in _quantities(shown.strip())),
        width,
        initial_indent=start,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [cut(line.replace(_GLUE, " "), width) for line in lines]


def cut(text: str, width: int = WIDTH) -> str:
    """Return a text that fits into a line of the terminal: between words, with how many are left out."""
    shown = escaped(text)
    if len(shown) <= width:
        return shown
    pieces = _quantities(shown)
    whole = _first_of(_changes(pieces), width, is_counted=True) or _first_of(pieces, width, is_counted=True)
    return whole or _first_of(pieces, width, is_counted=False) or f"{_AT_END.sub('', shown[: width - 3])}..."


def _first_of(pieces: Sequence[str], width: int, *, is_counted: bool) -> str:
    for kept in range(len(pieces) - 1, 0, -1):
        left = sum(piece.count(" ") + 1 for piece in pieces[kept:])
        head = " ".join(pieces[:kept])
        line = head.rstrip(",;") + (f" ... {count(left, 'word')} more" if is_counted else " ...")
        if len(line) <= width and head.strip() and not head.endswith(_ARROW):
            return line
    return ""


def _quantities(text: str) -> list[str]:
    """Return the words of a text; figures are one with those beside them, and with their unit."""
    pieces = list[str]()
    for word in text.split(" "):
        last = pieces[-1].rpartition(" ")[2] if pieces else ""
        if pieces and _goes_on(last, word):
            pieces[-1] += f" {word}"
        else:
            pieces.append(word)
    return pieces


def _goes_on(last: str, word: str) -> bool:
    if last == "N":
        return _OF_NEWTONS.fullmatch(word) is not None
    if _FIGURE.fullmatch(last) is None:
        return False
    unit = _UNIT.fullmatch(word)
    is_unit = unit is not None and (unit[1] in UNITS or unit[1] in _OWN_UNITS)
    return is_unit or _FIGURE.fullmatch(word.rstrip("),;:")) is not None


def _changes(pieces: Sequence[str]) -> list[str]:
    """Return pieces in which a value, the arrow behind it and the other value are one."""
    joined = list[str]()
    for piece in pieces:
        if joined and (piece == _ARROW or joined[-1].endswith(f" {_ARROW}")):
            joined[-1] += f" {piece}"
        else:
            joined.append(piece)
    return joined
