"""The one line that ends a report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from cellc.diagnostics import Diagnostic, Severity
from cellc.report.colour import GREEN, SEVERITY_COLOURS, paint
from cellc.report.escape import escape

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
