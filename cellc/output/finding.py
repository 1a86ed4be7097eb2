"""Build a diagnostic of this stage from its code."""

from __future__ import annotations

from pathlib import Path

from cellc.diagnostics import Diagnostic, Span
from cellc.output.codes import CODES

_PAGES = {page.code: page for page in CODES}


def finding(code: str, message: str, file: Path, advice: str = "") -> Diagnostic:
    """Return the diagnostic; it marks the first line of the file or folder that it is about.

    Raises:
        KeyError: the code has no page.
    """
    page = _PAGES[code]
    place = Span(file.as_posix(), 1, 1, 1, 1)
    return Diagnostic(code, page.severity, message, place, (), advice or page.fix)
