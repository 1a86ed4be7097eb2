"""Diagnostics as text for a person, in the manner of the best compilers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from cellc.diagnostics import Diagnostic
from cellc.report.colour import BLUE, BOLD, GREEN, SEVERITY_COLOURS, paint
from cellc.report.escape import escape
from cellc.report.snippet import Lines, render_snippet


def render_text(diagnostics: Iterable[Diagnostic], texts: Mapping[str, str], *, colour: bool) -> str:
    """Return every finding with its place, ordered by place and separated by empty lines.

    Args:
        texts: the text of every file that was read, by the name that spans carry, with line breaks as ``\\n``.

    Returns:
        Text that ends in a line break, or nothing where there is no finding.
    """
    lines: Lines = {file: text.split("\n") for file, text in texts.items()}
    blocks = [_render(diagnostic, lines, colour) for diagnostic in sorted(diagnostics, key=Diagnostic.sort_key)]
    return "\n\n".join(blocks) + "\n" if blocks else ""


def _render(diagnostic: Diagnostic, lines: Lines, colour: bool) -> str:
    style = SEVERITY_COLOURS[diagnostic.severity]
    head = paint(f"{diagnostic.severity.value}[{escape(diagnostic.code)}]", style, colour)
    gutter = _gutter(diagnostic)
    shown = [head + paint(f": {escape(diagnostic.message)}", BOLD, colour)]
    shown += render_snippet(diagnostic.span, lines, gutter=gutter, mark="^", style=style, colour=colour)
    for related in diagnostic.related:
        shown.append(f"{paint('note', BLUE, colour)}: {escape(related.message)}")
        shown += render_snippet(related.span, lines, gutter=gutter, mark="-", style=BLUE, colour=colour)
    if diagnostic.help:
        shown.append(f"{paint('help', GREEN, colour)}: {escape(diagnostic.help)}")
    return "\n".join(shown)


def _gutter(diagnostic: Diagnostic) -> int:
    numbers = [diagnostic.span.line, *(related.span.line for related in diagnostic.related)]
    return len(str(max(numbers)))
