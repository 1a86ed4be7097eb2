"""``audit.md``: what is not known, who answers for what, and what nobody can prove on the mock.

Markdown for the people who approve the cell. Left out: findings of ``cellc check``, which change with its version; the
audit holds what follows from the spec alone.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.formats.header import Header
from cellc.formats.open_questions import open_questions
from cellc.formats.parameter_file import spec_path
from cellc.graph.cell_graph import CellGraph

_QUESTIONS = {
    "graph": "Is there one command publisher or action server?",
    "time_tf": "Which stamp and calibration produced the goal?",
    "controller": "Are joints, interfaces, tolerance and hold defined?",
    "vendor": "Are firmware, driver, mode and scaling pinned?",
    "network": "Do discovery and data use controlled paths?",
    "safety": "Are stop, recovery and observer independent?",
    "data": "Can failures be replayed by layer?",
}


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the audit."""
    blocks = [
        f"<!--\n{header.text}\n-->",
        f"# {graph.cell.name}: audit",
        "## Open questions",
        _open(graph),
        "## Approvals",
        "\n".join(_approvals(graph.cell)),
        "## Responsibilities",
        "\n".join(_responsibilities(graph.cell)),
        "## Recovery",
        "\n".join(_recovery(graph.cell)),
        "## What the mock cannot prove",
        "\n".join(_not_provable(graph.cell)),
    ]
    yield Artifact("audit.md", "\n\n".join(blocks) + "\n")


def _open(graph: CellGraph) -> str:
    questions = open_questions(graph)
    if not questions:
        return "None."
    rows = [f"| {question.subject} | `{spec_path(question.path)}` |" for question in questions]
    return "\n".join(["| not known | answered in the spec at |", "|---|---|", *rows])


def _approvals(cell: Cell) -> Iterator[str]:
    yield "| area | question | owner |"
    yield "|---|---|---|"
    for area, owner in cell.spec.owners.approvals:
        yield f"| {area} | {_QUESTIONS[area]} | {owner} |"


def _responsibilities(cell: Cell) -> Iterator[str]:
    yield "| responsibility | owner |"
    yield "|---|---|"
    for name, owner in cell.spec.owners.responsibilities:
        yield f"| {name} | {owner} |"


def _recovery(cell: Cell) -> Iterator[str]:
    recovery = cell.spec.safety.recovery
    yield f"Acknowledged by: {recovery.acknowledge}. Owner: {recovery.owner}."
    yield f"After a reconnect: {recovery.on_reconnect}."
    for device in cell.devices:
        steps = () if device.facts.safety is None else device.facts.safety.recovery
        for way in steps:
            yield ""
            yield f"{device.name}, {way.state}:"
            yield ""
            yield from (f"{number}. {step}" for number, step in enumerate(way.steps, 1))


def _not_provable(cell: Cell) -> Iterator[str]:
    for device in cell.devices:
        yield from (f"- {device.name}: {text}" for text in device.facts.mock_cannot_prove)
