"""What a parser that is not ours says against an artifact."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.diagnostics import Diagnostic, Span
from cellc.verify.codes import CODES

_PAGES = {page.code: page for page in CODES}


@dataclass(frozen=True, slots=True)
class Disagreement:
    """A bug of cellc: which artifact is wrong, and how.

    Args:
        code: one of the ``verify-`` codes.
        path: the artifact.
        reason: continues "`path`: ".
    """

    code: str
    path: str
    reason: str

    def at(self, place: Span) -> Diagnostic:
        """Return the diagnostic; the place is the name of the cell, since no line of the spec is to blame."""
        page = _PAGES[self.code]
        message = f"generated `{self.path}`: {self.reason} (this is a bug of cellc)"
        return Diagnostic(self.code, page.severity, " ".join(message.split()), place, ("cell",), page.fix)
