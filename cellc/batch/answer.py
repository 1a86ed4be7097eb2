"""What a command needs of one spec, without the graph behind it, so that it can be kept and sent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cellc.artifact import Artifact
from cellc.diagnostics import Span
from cellc.diagnostics.findings import Findings
from cellc.diagnostics.plain import findings_of, plain_of_findings, plain_of_span


@dataclass(frozen=True, slots=True)
class NamedCell:
    """The name of a cell, which is that of its folder, and where the spec gives it."""

    name: str
    span: Span


@dataclass(frozen=True, slots=True)
class Answer:
    """A spec that was checked, or compiled too.

    Args:
        cell: None where an error hides it, or nobody asked.
        artifacts: with the manifest over them; None where an error stops them, or nobody asked.
    """

    findings: Findings
    cell: NamedCell | None = None
    artifacts: tuple[Artifact, ...] | None = None


def plain_of(answer: Answer) -> dict[str, Any]:
    """Return an answer as JSON values."""
    artifacts = answer.artifacts
    return {
        "findings": plain_of_findings(answer.findings),
        "cell": None if answer.cell is None else [answer.cell.name, plain_of_span(answer.cell.span)],
        "artifacts": None if artifacts is None else [[artifact.path, artifact.text] for artifact in artifacts],
    }


def answer_of(plain: dict[str, Any]) -> Answer:
    """Read what `plain_of` wrote.

    Raises:
        KeyError, TypeError, ValueError: it is something else.
    """
    cell, artifacts = plain["cell"], plain["artifacts"]
    return Answer(
        findings_of(plain["findings"]),
        None if cell is None else NamedCell(cell[0], Span(*cell[1])),
        None if artifacts is None else tuple(Artifact(path, text) for path, text in artifacts),
    )
