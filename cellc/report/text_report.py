"""Findings, differences and diagnoses as text for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cellc.diagnostics import Diagnostic, Severity
from cellc.report.terminal import BLUE, BOLD, GREEN, SEVERITY_COLOURS, Lines, escape, paint, render_snippet

if TYPE_CHECKING:
    from cellc.diagnose.diagnose import Cause, Suspicion
    from cellc.output.compare import Difference


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


_NOUNS = {
    Severity.ERROR: ("error", "errors"),
    Severity.BLOCKER: ("blocker", "blockers"),
    Severity.WARNING: ("warning", "warnings"),
    Severity.AUDIT: ("audit item", "audit items"),
}


def counts(diagnostics: Iterable[Diagnostic]) -> dict[str, int]:
    """Return the number of findings of every severity, the worst first, zeros included."""
    found = Counter(diagnostic.severity for diagnostic in diagnostics)
    return {severity.value: found[severity] for severity in Severity}


def summary(diagnostics: Iterable[Diagnostic], files: Sequence[str], *, colour: bool = False) -> str:
    """Return such as ``2 errors, 1 blocker in cells/a.yaml``, or that nothing was found; without line break.

    Args:
        files: the specs that were checked, as the user named them.
    """
    found = counts(diagnostics)
    parts = [_part(severity, found[severity.value], colour) for severity in Severity if found[severity.value]]
    place = escape(files[0]) if len(files) == 1 else f"{len(files)} files"
    return f"{', '.join(parts) or paint('no findings', GREEN, colour)} in {place}"


def _part(severity: Severity, number: int, colour: bool) -> str:
    singular, plural = _NOUNS[severity]
    return paint(f"{number} {singular if number == 1 else plural}", SEVERITY_COLOURS[severity], colour)


_WHY = {
    "missing": "is missing",
    "outdated": "is from an earlier build",
    "edited": "was edited by hand",
    "unexpected": "is no longer made by the cell",
}


def render_difference(difference: Difference, folder: Path) -> str:
    """Write one difference: the file, why it differs, and its first differing line."""
    path = (folder / difference.path).as_posix()
    text = f"{path}: {_WHY[difference.kind]}"
    if difference.line:
        text = f"{path}:{difference.line}: {_WHY[difference.kind]}"
        text += f"\n  - {_line(difference.found)}\n  + {_line(difference.expected)}"
    return text


def _line(line: str | None) -> str:
    return "(end of file)" if line is None else escape(line)[:160]


def render_suspicions(suspicions: tuple[Suspicion, ...], *, colour: bool) -> str:
    """Return every suspicion with its hypotheses, the best first, ending in a line break."""
    blocks = ["\n".join(_suspicion(one, colour)) for one in suspicions]
    return "\n\n".join(blocks) + "\n"


def _suspicion(suspicion: Suspicion, colour: bool) -> Iterator[str]:
    yield paint(f"{suspicion.layer}: {suspicion.symptom}", BOLD, colour)
    if suspicion.evidence:
        yield f"  the line names: {escape(', '.join(suspicion.evidence))}"
    for name in suspicion.unknown:
        yield f"  {escape(name)} is not part of this cell"
    for number, cause in enumerate(suspicion.causes, 1):
        yield from _cause(number, cause, colour)
    yield f"  do not: {suspicion.never}"
    yield f"  who decides: {escape(suspicion.owner)}"
    yield f"  source: {suspicion.source}"


def _cause(number: int, cause: Cause, colour: bool) -> Iterator[str]:
    yield f"  {number}. {cause.text}?"
    for step in cause.steps:
        mark = "$" if step.is_command else "look at"
        yield f"     {paint(mark, BLUE, colour)} {escape(step.action)}"
        yield f"       {paint('ruled out if', GREEN, colour)} {escape(step.refuted)}"
    if cause.omitted:
        yield f"     and the same for {cause.omitted} more; name one in the symptom to see it alone"
