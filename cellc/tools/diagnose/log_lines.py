"""Log lines as programs write them, found again in what somebody pasted.

A template is the text of the source with ``{controller}`` where it names a controller, and ``{}`` where it says what
nothing asks for, such as a number. At its end a place is one word, and ``{reason}`` all that follows up to the next
line with a level in brackets. The pasted text may have times, names of nodes, colors and line breaks around it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

Named = tuple[tuple[str, str], ...]
"""What a line names: (kind, name)."""

_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_HOLE = re.compile(r"\{(\w*)\}")
_MINOR = re.compile(r"\[ ?(?:INFO|DEBUG)\]")
_WARNING = re.compile(r"\[ ?WARN(?:ING)?\]")
_ERROR = re.compile(r"\[ ?(?:ERROR|FATAL)\]")
_UNSAID = re.compile(
    r"\[[\w .-]+-\d+\]|\[ ?(?:INFO|DEBUG|WARN|WARNING|ERROR|FATAL)\]|\[\d[\d. ,-]*\]:?|, cmd '[^']*'?|\[pid \d+"
    r"|(?<![\w/])/(?!dev/)[\w.+~-]+(?:/[\w.+~-]+){2,}|0x[0-9a-fA-F]+|\b\d{4,}(?:\.\d+)?\b"
)
"""Of a log line: its process, level and time, a command, a path that is no device, and long numbers."""
_LONGEST_NAME = 200
_AROUND = " '\"`.,:;()[]!"
_REST = "reason"
_NEXT_LINE = " ["


def plain(text: str) -> str:
    """Return a pasted text as one line without colors."""
    return " ".join(_COLOUR.sub("", text).split())


def spoken(text: str) -> str:
    """Return what a text says in words: without heads, paths, commands and numbers, and without lines of no gravity."""
    lines = _COLOUR.sub("", text).splitlines()
    grave = [line for line in lines if not _MINOR.search(line)]
    return "\n".join(_UNSAID.sub(" ", line) for line in grave or lines)


def graver(text: str) -> str:
    """Return a text without its warnings where it has errors: those may be of long ago, or of every start."""
    lines = text.splitlines()
    has_errors = any(_ERROR.search(line) for line in lines)
    return "\n".join(line for line in lines if not has_errors or not _WARNING.search(line))


def found_in(template: str, text: str) -> Named | None:
    """Return what a text names at the places of a template, None where the text does not hold it.

    Args:
        template: begins with text, and has text between two places.
        text: one line, as ``plain`` gives it.
    """
    first, kinds, rest = _parts(template)
    start = text.find(first)
    while start >= 0:
        names = _names(kinds, rest, text, start + len(first))
        if names is not None:
            pairs = zip(kinds, names, strict=True)
            return tuple(dict.fromkeys((kind, name) for kind, name in pairs if kind and name))
        start = text.find(first, start + 1)
    return None


@cache
def _parts(template: str) -> tuple[str, Sequence[str], Sequence[str]]:
    pieces = _HOLE.split(template)
    return pieces[0], pieces[1::2], pieces[2::2]


def _names(kinds: Sequence[str], pieces: Sequence[str], text: str, position: int) -> list[str] | None:
    names: list[str] = []
    for kind, piece in zip(kinds, pieces, strict=True):
        until = piece or (_NEXT_LINE if kind == _REST else " ")  # no piece: the template ends with this place
        end = text.find(until, position, position + _LONGEST_NAME + len(until))
        if end < 0 and piece:
            return None
        end = min(len(text), position + _LONGEST_NAME) if end < 0 else end
        names.append(text[position:end].strip(_AROUND))
        position = end + len(piece)
    return names


def fixed_begin(template: str) -> str:
    """Return the text that a template begins with."""
    return _parts(template)[0]


def length(template: str) -> int:
    """Return how many letters of a template stand fast: a longer one says more."""
    return len(_HOLE.sub("", template))
