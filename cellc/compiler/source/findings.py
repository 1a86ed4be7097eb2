"""The diagnostic of a code that reading a spec reports."""

from __future__ import annotations

from cellc.contract.code_page import page_of
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Diagnostic, Related, Span, YamlPath
from cellc.contract.limits import option


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
    return Diagnostic(code, STAGES["source"][code], message, span, path, help_text, related)
