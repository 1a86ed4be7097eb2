"""The one value in which every stage reports to the user."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from cellc.diagnostics.span import Span, YamlPath


class Severity(str, Enum):
    """How much a finding stops.

    ERROR: no artifact is written. BLOCKER: artifacts for the mock are written, the real target is refused.
    WARNING: written and reported. AUDIT: an open question with a human owner.
    """

    ERROR = "error"
    BLOCKER = "blocker"
    WARNING = "warning"
    AUDIT = "audit"


@dataclass(frozen=True, slots=True)
class Related:
    """A second place that explains the first, such as "first claimed here"."""

    message: str
    span: Span


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding: what is wrong, where, and what to do about it.

    Args:
        code: stable name of the defect, such as ``reversed-limits``.
        message: one line, lower case, with the actual and the allowed value.
        span: the culprit in a file of the user.
        yaml_path: the same place as a path in the document.
        help: what to do, beginning with a verb; empty where nothing general can be said.
        related: other places that belong to the finding.
    """

    code: str
    severity: Severity
    message: str
    span: Span
    yaml_path: YamlPath = ()
    help: str = ""
    related: tuple[Related, ...] = ()

    def sort_key(self) -> tuple[Span, str, str]:
        """Order by place, then code, then message, so that output never depends on the order of checks."""
        return (self.span, self.code, self.message)
