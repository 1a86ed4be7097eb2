"""What the compiler says to its user: places in files, diagnostics, and outcomes of stages."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from enum import Enum
from typing import Generic, TypeVar, Union

from cellc.contract.diagnostics.notebook import html_table
from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.diagnostics.wording import count
from cellc.contract.frozen import dataclass

T = TypeVar("T")
YamlPath = tuple[Union[str, int], ...]
"""Keys and list indices from the root of a YAML document to one of its nodes."""


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A half-open range of text; lines and columns count from 1, columns count characters.

    ``file`` is the path as the user named it, with forward slashes, so that output is the same on every machine.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


def format_path(path: YamlPath) -> str:
    """Write a YAML path as ``devices.arm.mount`` or ``steps[2].move``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += f".{part}" if text else part
    return text


class Severity(str, Enum):
    """How much a finding stops.

    ERROR: no artifact is written. BLOCKER: artifacts for the mock are written, the real target is refused.
    WARNING: written and reported. AUDIT: an open question with a human owner.
    """

    ERROR = "error"
    BLOCKER = "blocker"
    WARNING = "warning"
    AUDIT = "audit"

    @property
    def rank(self) -> int:
        """Its place in the order from the worst."""
        return tuple(Severity).index(self)

    def counted(self, number: int) -> str:
        """Return such as ``2 errors`` or ``1 audit item``."""
        return count(number, "audit item" if self is Severity.AUDIT else self.value)


@dataclass(frozen=True, slots=True)
class Related:
    """A second place that explains the first, such as "first claimed here"."""

    message: str
    span: Span


@dataclass(frozen=True, slots=True)
class Fix:
    """The edit that ends a finding: what a span holds becomes another text.

    Args:
        span: characters of one line, in the file of the finding.
        written: what it holds.
        text: what it becomes.
        sure: nothing else can have been meant: ``cellc check --fix`` makes it. Else a person chooses it in an editor.
    """

    span: Span
    written: str
    text: str
    sure: bool


@dataclass(frozen=True, slots=True, repr=False)
class Diagnostic:
    """One finding: what is wrong, where, and what to do about it.

    Printed, it is one line, as compilers write it.

    Args:
        code: stable name of the defect, such as ``reversed-limits``.
        message: one line, lower case, with the actual and the allowed value.
        span: the culprit in a file of the user.
        yaml_path: the same place as a path in the document.
        help: what to do, beginning with a verb; empty where nothing general can be said.
        related: other places that belong to the finding.
        fix: the edit that ends it, where one is near enough.
    """

    code: str
    severity: Severity
    message: str
    span: Span
    yaml_path: YamlPath = ()
    help: str = ""
    related: tuple[Related, ...] = ()
    fix: Fix | None = None

    def __str__(self) -> str:
        return escaped(f"{self.span}: {self.severity.value}[{self.code}]: {self.message}")

    def __repr__(self) -> str:
        return f"<{self}>"

    def sort_key(self) -> tuple[Span, str, str]:
        """Order by place, then code, then message, so that output never depends on the order of checks."""
        return (self.span, self.code, self.message)


def counted(diagnostics: Iterable[Diagnostic]) -> str:
    """Return such as ``2 errors, 1 blocker``, the worst first, or ``no findings``."""
    counts = Counter(diagnostic.severity for diagnostic in diagnostics)
    return ", ".join(severity.counted(counts[severity]) for severity in Severity if counts[severity]) or "no findings"


def findings_table(caption: str, diagnostics: Iterable[Diagnostic]) -> str:
    """Return findings as a table of HTML, in their order."""
    rows = (
        (diagnostic.severity.value, diagnostic.code, str(diagnostic.span), diagnostic.message, diagnostic.help)
        for diagnostic in diagnostics
    )
    return html_table(caption, ("severity", "code", "place", "what is wrong", "help"), rows)


@dataclass(frozen=True, slots=True, repr=False)
class Outcome(Generic[T]):
    """What a stage returns: its value where it could make one, and every diagnostic that it has to tell."""

    value: T | None
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the next stage may go on: there is a value and no error."""
        return self.value is not None and not any(d.severity is Severity.ERROR for d in self.diagnostics)

    def __repr__(self) -> str:
        kind = "no value" if self.value is None else type(self.value).__name__
        return f"<Outcome: {kind}, {counted(self.diagnostics)}>"

    def _repr_html_(self) -> str:
        return findings_table(repr(self).strip("<>"), self.diagnostics)


@dataclass(frozen=True, slots=True)
class Findings:
    """The findings of all stages, sorted by place.

    Args:
        file: the spec as the user named it.
        texts: every file that was read, by the name that spans carry.
    """

    file: str
    texts: Mapping[str, str]
    diagnostics: tuple[Diagnostic, ...]

    @property
    def ok(self) -> bool:
        """Whether nothing was found that stops artifacts."""
        return all(diagnostic.severity is not Severity.ERROR for diagnostic in self.diagnostics)

    def with_more(self, found: Iterable[Diagnostic]) -> Findings:
        """Add findings of a later stage."""
        return replace(self, diagnostics=tuple(sorted((*self.diagnostics, *found), key=Diagnostic.sort_key)))
