"""What a command needs of one spec, without the graph behind it, so that it can be kept and sent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cellc.artifact import Artifact
from cellc.diagnostics import Span
from cellc.diagnostics.findings import Findings
from cellc.diagnostics.plain import findings_of, plain_of_findings, plain_of_span
from cellc.fleet.presence import Presence


@dataclass(frozen=True, slots=True)
class Answer:
    """A spec that was checked, or compiled too.

    Args:
        cell: as the other cells of the call see it; None where an error hides it.
        artifacts: with the manifest over them; None where an error stops them, or nobody asked.
    """

    findings: Findings
    cell: Presence | None = None
    artifacts: tuple[Artifact, ...] | None = None


def plain_of(answer: Answer) -> dict[str, Any]:
    """Return an answer as JSON values."""
    artifacts = answer.artifacts
    return {
        "findings": plain_of_findings(answer.findings),
        "cell": None if answer.cell is None else _plain_of_cell(answer.cell),
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
        None if cell is None else _cell_of(cell),
        None if artifacts is None else tuple(Artifact(path, text) for path, text in artifacts),
    )


def _plain_of_cell(cell: Presence) -> list[Any]:
    network = [cell.domain_id, cell.discovery, list(cell.cards), list(cell.peers), plain_of_span(cell.domain_at)]
    return [cell.name, plain_of_span(cell.named_at), *network]


def _cell_of(plain: list[Any]) -> Presence:
    name, named_at, domain_id, discovery, cards, peers, domain_at = plain
    return Presence(name, Span(*named_at), domain_id, discovery, tuple(cards), tuple(peers), Span(*domain_at))
