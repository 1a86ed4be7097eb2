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
from cellc.contract.diagnostics.nearest import Advice, did_you_mean, is_slip, meant, nearest, only_nearest, write

__all__ = [
    "Advice",
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
    "meant",
    "nearest",
    "only_nearest",
    "write",
]
