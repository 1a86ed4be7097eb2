"""Diagnostics as JSON for programs; the object is stable under its ``format`` number.

``{"format": 1, "diagnostics": [...], "summary": {"error": 0, "blocker": 0, "warning": 0, "audit": 0}}``. A diagnostic
has ``code``, ``severity``, ``message``, ``file``, ``line``, ``column``, ``end_line``, ``end_column`` (from 1, end
exclusive, in characters), ``path`` (keys and indices from the root), ``help`` (may be empty), ``related`` (places
with a message) and ``fix``: null, or the place, the ``text`` that belongs there, and whether nothing else can have been
meant (``sure``).
"""

from __future__ import annotations

import json
from collections.abc import Iterable

from cellc.contract.diagnostics import Diagnostic, Span
from cellc.contract.diagnostics.unsafe_text import harmless_json
from cellc.contract.review import ReviewFinding
from cellc.tools.report.text_report import counts

JSON_FORMAT = 1


def render_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Return the JSON object, keys in fixed order, findings by place, pure ASCII, ending in a line break."""
    ordered = sorted(diagnostics, key=Diagnostic.sort_key)
    report = {
        "format": JSON_FORMAT,
        "diagnostics": [_diagnostic(diagnostic) for diagnostic in ordered],
        "summary": counts(ordered),
    }
    return harmless_json(json.dumps(report, indent=2)) + "\n"


def _diagnostic(diagnostic: Diagnostic) -> dict[str, object]:
    fix = diagnostic.fix
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity.value,
        "message": diagnostic.message,
        **_place(diagnostic.span),
        "path": list(diagnostic.yaml_path),
        "help": diagnostic.help,
        "related": [{"message": related.message, **_place(related.span)} for related in diagnostic.related],
        "fix": None if fix is None else {**_place(fix.span), "text": fix.text, "sure": fix.sure},
    }


def as_review_finding(found: Diagnostic) -> ReviewFinding:
    """Return a finding as reviews and tables of many cells have it."""
    return ReviewFinding(code=found.code, severity=found.severity.value, message=found.message, place=str(found.span))


def _place(span: Span) -> dict[str, object]:
    return {
        "file": span.file,
        "line": span.line,
        "column": span.column,
        "end_line": span.end_line,
        "end_column": span.end_column,
    }
