"""Events and comments of a YAML text, and the spans that a reader of the file would draw for them."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence

import yaml

from cellc.contract.diagnostics import Span
from cellc.contract.frozen import dataclass

_FAST = getattr(yaml, "CLoader", None)


def parse_events(text: str, *, pure: bool = False) -> Iterator[yaml.Event]:
    """Yield the events of ``text`` one by one, so that a reader can stop at the first that it refuses.

    Args:
        pure: use the parser written in Python even where libyaml is there; both give the same events.

    Raises:
        yaml.YAMLError: the text is not YAML.
        ValueError: in Python's parser alone, for an escape or a directive with an absurdly large number.
    """
    loader = yaml.Loader if pure or _FAST is None else _FAST
    yield from yaml.parse(text, Loader=loader)


def event_span(event: yaml.Event, file: str, lines: Sequence[str]) -> Span:
    """Return the text of a scalar or alias, or the first character of a collection.

    Parsers end a block scalar at the start of what follows it; its span here ends with its last written character.
    """
    # Every event that comes from a parser has both marks.
    assert event.start_mark is not None
    assert event.end_mark is not None
    line, column = event.start_mark.line, event.start_mark.column
    if isinstance(event, yaml.CollectionStartEvent):
        return Span(file, line + 1, column + 1, line + 1, column + 2)
    end_line, end_column = last_written(lines, event.end_mark.line, event.end_mark.column)
    # A value that was left out is marked where the text before it ends; the two parsers differ in where it begins.
    line, column = min((line, column), (end_line, end_column))
    return Span(file, line + 1, column + 1, end_line + 1, end_column + 1)


def last_written(lines: Sequence[str], line: int, column: int) -> tuple[int, int]:
    """Return the place, counted from 0, behind the last character that is written before the given one."""
    while True:
        before = lines[line][:column].rstrip() if line < len(lines) else ""
        if before or line == 0:
            return line, len(before)
        line -= 1
        column = len(lines[line]) if line < len(lines) else 0


def flow_span(start: yaml.Event, end: yaml.Event, file: str) -> Span | None:
    """Return a collection in brackets or braces that is on one line, else None."""
    first, last = start.start_mark, end.end_mark
    # Every event that comes from a parser has both marks.
    assert first is not None
    assert last is not None
    if not getattr(start, "flow_style", False) or first.line != last.line:
        return None
    return Span(file, first.line + 1, first.column + 1, last.line + 1, last.column + 1)


_BLOCK_STYLES = ("|", ">")


@dataclass(frozen=True, slots=True)
class Comment:
    """One comment from its ``#`` to the end of its line; line and column count from 1."""

    line: int
    column: int
    text: str


def comments(text: str, marker: re.Pattern[str], *, pure: bool = False) -> tuple[Comment, ...]:
    """Return the comments in which ``marker`` begins, each from its first one on.

    The scanner decides what a comment is: a ``#`` inside a quoted text or a block of text does not start one. The text
    is scanned only where the marker occurs, so that a file without it costs nothing.

    Args:
        text: valid YAML with line breaks as ``\\n``.
        marker: matches from a ``#`` on, within one line.
        pure: use the scanner written in Python; both give the same comments.
    """
    lines = text.split("\n")
    if not any(map(marker.search, lines)):
        return ()
    # Scalars come in the order of the text and do not overlap: the last that begins before a comment may hold it.
    scalars = list(_scalars(text, pure))
    starts = [start for start, _ in scalars]

    def is_comment(at: tuple[int, int]) -> bool:
        place = bisect_right(starts, at)
        return not place or scalars[place - 1][1] <= at

    found: list[Comment] = []
    for number, line in enumerate(lines):
        columns = (match.start() for match in marker.finditer(line))
        # A comment goes on to the end of its line, whatever looks like another one in it.
        column = next((column for column in columns if is_comment((number, column))), None)
        if column is not None:
            found.append(Comment(number + 1, column + 1, line[column:].rstrip()))
    return tuple(found)


def _scalars(text: str, pure: bool) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield the range of every scalar as line and column from 0, the end exclusive."""
    loader = yaml.Loader if pure or _FAST is None else _FAST
    for token in yaml.scan(text, Loader=loader):
        if isinstance(token, yaml.ScalarToken):
            # A comment may follow the indicator of a block on its own line; the content begins below.
            is_block = token.style in _BLOCK_STYLES
            start = (token.start_mark.line + 1, 0) if is_block else (token.start_mark.line, token.start_mark.column)
            yield start, (token.end_mark.line, token.end_mark.column)
