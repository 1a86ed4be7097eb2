"""What the compiler says to its user: spans, diagnostics and outcomes."""

from cellc.diagnostics.diagnostic import Diagnostic, Related, Severity
from cellc.diagnostics.nearest import did_you_mean, nearest, only_suggestion
from cellc.diagnostics.outcome import Outcome
from cellc.diagnostics.span import Span, YamlPath, format_path

__all__ = [
    "Diagnostic",
    "Outcome",
    "Related",
    "Severity",
    "Span",
    "YamlPath",
    "did_you_mean",
    "format_path",
    "nearest",
    "only_suggestion",
]
