"""Diagnostics as JSON values and back, nothing lost; not the report for programs, which is `report.json_report`."""

from __future__ import annotations

from typing import Any

from cellc.diagnostics.diagnostic import Diagnostic, Related, Severity
from cellc.diagnostics.findings import Findings
from cellc.diagnostics.span import Span

Plain = list[Any]


def plain_of_span(span: Span) -> Plain:
    """Return a span as a list."""
    return [span.file, span.line, span.column, span.end_line, span.end_column]


def plain_of_findings(findings: Findings) -> Plain:
    """Return findings as a list."""
    return [findings.file, dict(findings.texts), [_plain_of(found) for found in findings.diagnostics]]


def findings_of(plain: Plain) -> Findings:
    """Read what `plain_of_findings` wrote.

    Raises:
        TypeError, ValueError: it is something else.
    """
    file, texts, diagnostics = plain
    return Findings(file, texts, tuple(_diagnostic_of(found) for found in diagnostics))


def _plain_of(found: Diagnostic) -> Plain:
    related = [[other.message, plain_of_span(other.span)] for other in found.related]
    place = [plain_of_span(found.span), list(found.yaml_path)]
    return [found.code, found.severity.value, found.message, *place, found.help, related]


def _diagnostic_of(plain: Plain) -> Diagnostic:
    code, severity, message, span, path, help_text, related = plain
    others = tuple(Related(said, Span(*place)) for said, place in related)
    return Diagnostic(code, Severity(severity), message, Span(*span), tuple(path), help_text, others)
