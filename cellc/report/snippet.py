"""Show one place of a file: where it is, the line, and carets under the culprit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cellc.diagnostics import Span
from cellc.report.colour import BLUE, paint
from cellc.report.escape import escape
from cellc.report.excerpt import excerpt

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
