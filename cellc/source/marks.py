"""Turn the marks of YAML events into spans that a reader of the file would draw."""

from __future__ import annotations

from collections.abc import Sequence

import yaml

from cellc.diagnostics import Span


def event_span(event: yaml.Event, file: str, lines: Sequence[str]) -> Span:
    """Return the text of a scalar or alias, or the first character of a collection.

    Parsers end a block scalar at the start of what follows it; its span here ends with its last written character.
    """
    assert event.start_mark is not None and event.end_mark is not None  # every event of a parser has both
    line, column = event.start_mark.line, event.start_mark.column
    if isinstance(event, yaml.CollectionStartEvent):
        return Span(file, line + 1, column + 1, line + 1, column + 2)
    end_line, end_column = event.end_mark.line, event.end_mark.column
    while end_line > line and not _before(lines, end_line, end_column).strip():
        end_line -= 1
        end_column = len(lines[end_line].rstrip())
    return Span(file, line + 1, column + 1, end_line + 1, end_column + 1)


def flow_span(start: yaml.Event, end: yaml.Event, file: str) -> Span | None:
    """Return a collection in brackets or braces that stands on one line, else None."""
    first, last = start.start_mark, end.end_mark
    assert first is not None and last is not None  # every event of a parser has both
    if not getattr(start, "flow_style", False) or first.line != last.line:
        return None
    return Span(file, first.line + 1, first.column + 1, last.line + 1, last.column + 1)


def _before(lines: Sequence[str], line: int, column: int) -> str:
    return lines[line][:column] if line < len(lines) else ""
