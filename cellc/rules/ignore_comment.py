"""Reads comments such as ``# cellc: ignore CODE, CODE reason``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from cellc.diagnostics import Span
from cellc.source.comments import Comment, comments

_MARKER = re.compile(r"(?<!\S)#\s*cellc:\s*ignore\b")
_CODE = re.compile(r"[\w-]+")
_NEXT = re.compile(r"\s*,\s*")
# What people put between the codes and the reason.
_SEPARATORS = " \t:-–—("


@dataclass(frozen=True, slots=True)
class IgnoredCode:
    """One code of a comment and where it is written."""

    code: str
    span: Span


@dataclass(frozen=True, slots=True)
class IgnoreComment:
    """One comment: the codes that it ignores on its line, and why; the reason may be missing."""

    span: Span
    codes: tuple[IgnoredCode, ...]
    reason: str


def ignore_comments(texts: Mapping[str, str]) -> tuple[IgnoreComment, ...]:
    """Return the comments of all files of a spec that ignore something.

    Args:
        texts: valid YAML by the name that spans carry.
    """
    return tuple(_read(file, comment) for file, text in texts.items() for comment in comments(text, _MARKER))


def _read(file: str, comment: Comment) -> IgnoreComment:
    head = _MARKER.match(comment.text)
    assert head is not None  # the comment begins where the marker was found
    codes, end = [], head.end()
    for start, end in _codes(comment.text, head.end()):
        codes.append(IgnoredCode(comment.text[start:end], _span(file, comment, start, end)))
    reason = comment.text[end:].strip(_SEPARATORS)
    return IgnoreComment(_span(file, comment, 0, len(comment.text)), tuple(codes), reason)


def _codes(text: str, position: int) -> Iterator[tuple[int, int]]:
    """Yield start and end of every code; the first word behind the codes begins the reason."""
    start = position + len(text[position:]) - len(text[position:].lstrip())
    while match := _CODE.match(text, start):
        yield match.span()
        following = _NEXT.match(text, match.end())
        if following is None:
            return
        start = following.end()


def _span(file: str, comment: Comment, start: int, end: int) -> Span:
    return Span(file, comment.line, comment.column + start, comment.line, comment.column + end)
