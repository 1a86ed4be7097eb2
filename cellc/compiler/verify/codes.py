"""What a foreign parser can say against an artifact, and the page of each code; each of them is a bug of cellc."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.contract.diagnostics import Diagnostic, Severity, Span
from cellc.contract.diagnostics.diagnostic import CodePage

_FIX = "report it with the spec; nothing in the spec has to be changed"


def _page(code: str, title: str, why: str) -> CodePage:
    return CodePage(code, Severity.ERROR, title, why, _FIX)


CODES: tuple[CodePage, ...] = (
    _page(
        "verify-frames",
        "the generated robot description puts a link elsewhere than the cell does",
        "Each link's pose is computed by two parsers that cellc did not write, at joint position zero and away from "
        "it, and compared with the frames of the spec. Where they differ a planner and tf2 would not agree.",
    ),
    _page(
        "verify-json",
        "a generated JSON file does not fit its published schema",
        "The mock and other tools rely on the schema, and on every file naming the same configuration.",
    ),
    _page(
        "verify-joints",
        "parsers read other joints or limits from the generated robot description than the cell has",
        "Two parsers that cellc did not write list the movable joints with their limits; a joint that one of them does "
        "not see, or bounds otherwise, is missing or wrong in the file.",
    ),
    _page(
        "verify-text",
        "a generated file is not well-formed",
        "XML and YAML files are read back by common parsers before they are written to the disk.",
    ),
    _page(
        "verify-urdf",
        "a parser refuses the generated robot description",
        "pinocchio and yourdfpy read every URDF before it is written; what they refuse no robot can load.",
    ),
)

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
