"""What the compiler says to its user: spans, diagnostics and outcomes."""

from cellc.contract.diagnostics.diagnostic import (
    Diagnostic,
    Fix,
    Outcome,
    Related,
    Severity,
    Span,
    YamlPath,
    format_path,
)
from cellc.contract.diagnostics.nearest import did_you_mean, is_slip, nearest, only_nearest

__all__ = [
    "Diagnostic",
    "Fix",
    "Outcome",
    "Related",
    "Severity",
    "Span",
    "YamlPath",
    "did_you_mean",
    "format_path",
    "is_slip",
    "nearest",
    "only_nearest",
]
