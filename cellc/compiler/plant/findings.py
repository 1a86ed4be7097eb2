"""The diagnostic of a code that a plant reports."""

from __future__ import annotations

from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath


def finding(
    code: str, message: str, span: Span, path: YamlPath, advice: str, related: tuple[Related, ...] = ()
) -> Diagnostic:
    """Return the finding; but for warnings it is an error: a plant has no real target that a blocker could refuse."""
    severity = STAGES["plant"].get(code, Severity.ERROR)
    return Diagnostic(code, severity, message, span, path, advice, related)
