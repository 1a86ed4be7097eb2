"""The diagnostic of a code that a plant reports."""

from __future__ import annotations

from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath


def finding(
    code: str, message: str, span: Span, path: YamlPath, advice: str, related: tuple[Related, ...] = ()
) -> Diagnostic:
    """Return an error: a plant has no real target of its own that a blocker could refuse."""
    return Diagnostic(code, Severity.ERROR, message, span, path, advice, related)
