"""Turn the marks of YAML events into spans that a reader of the file would draw."""

from __future__ import annotations

from collections.abc import Sequence

import yaml

from cellc.diagnostics import Span


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
    """Return a collection in brackets or braces that stands on one line, else None."""
    first, last = start.start_mark, end.end_mark
    # Every event that comes from a parser has both marks.
    assert first is not None
    assert last is not None
    if not getattr(start, "flow_style", False) or first.line != last.line:
        return None
    return Span(file, first.line + 1, first.column + 1, last.line + 1, last.column + 1)
