"""Build a diagnostic of this stage from its code."""

from __future__ import annotations

from cellc.diagnostics import Diagnostic, Related, Span, YamlPath
from cellc.source.codes import CODES

_PAGES = {page.code: page for page in CODES}


def finding(
    code: str,
    message: str,
    span: Span,
    *,
    path: YamlPath = (),
    advice: str = "",
    related: tuple[Related, ...] = (),
) -> Diagnostic:
    """Return the diagnostic; without ``advice`` its help is the fix from the page of the code.

    Raises:
        KeyError: the code has no page.
    """
    page = _PAGES[code]
    return Diagnostic(code, page.severity, message, span, path, advice or page.fix, related)
