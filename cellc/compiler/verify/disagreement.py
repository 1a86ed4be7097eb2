"""What a foreign parser can say against an artifact; each of it is a bug of cellc."""

from __future__ import annotations

from cellc.contract.code_page import page_of
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Diagnostic, Span
from cellc.contract.frozen import dataclass


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
        message = f"generated `{self.path}`: {self.reason} (this is a bug of cellc)"
        severity, fix = STAGES["verify"][self.code], page_of(self.code).fix
        return Diagnostic(self.code, severity, " ".join(message.split()), place, ("cell",), fix)
