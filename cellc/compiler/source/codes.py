"""Every code that reading a spec can report, and the diagnostic of a code."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.code_page import page_of
from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath
from cellc.contract.limits import option

CODES: Mapping[str, Severity] = dict.fromkeys(
    (
        "alias-bomb",
        "command-too-long",
        "control-character",
        "duplicate-key",
        "empty-file",
        "file-not-found",
        "file-too-large",
        "file-unreadable",
        "include-cycle",
        "include-escape",
        "include-shape",
        "key-collision",
        "merge-key",
        "non-string-key",
        "not-a-cell",
        "not-a-file",
        "not-utf8",
        "not-yaml",
        "number-out-of-range",
        "recursive-alias",
        "root-not-mapping",
        "several-documents",
        "substitution-in-text",
        "tab-indentation",
        "too-deep",
        "too-many-includes",
        "too-many-values",
        "unknown-alias",
        "yaml-tag",
    ),
    Severity.ERROR,
)


def finding(
    code: str,
    message: str,
    span: Span,
    *,
    path: YamlPath = (),
    advice: str = "",
    limit: str = "",
    related: tuple[Related, ...] = (),
) -> Diagnostic:
    """Return the diagnostic; without ``advice`` its help is the fix of the page of the code.

    Args:
        limit: the row of the table of limits that is exceeded; the help tells how to raise it.

    Raises:
        KeyError: there is no such code.
    """
    help_text = advice or page_of(code).fix
    if limit:
        help_text += f"; {option(limit)}"
    return Diagnostic(code, CODES[code], message, span, path, help_text, related)
