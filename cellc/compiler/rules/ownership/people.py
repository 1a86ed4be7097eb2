"""Rules on the people who own a part of the cell, or approve it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from difflib import SequenceMatcher

from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.graph.responsibilities import Responsibility
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, meant, rule
from cellc.contract.vocabulary import UNKNOWN


@rule(Severity.BLOCKER)
def missing_approval(graph: CellGraph) -> Findings:
    """Yield the approval areas without an owner; those that the spec does not mention in one finding."""
    stated, others = _open(graph, "approval")
    for item in stated:
        yield found(graph, item.path, f"no owner approves `{item.name}`")
    if others:
        yield found(graph, ("owners", "approvals"), f"no owner approves {others}")


@rule(Severity.BLOCKER)
def missing_responsibility(graph: CellGraph) -> Findings:
    """Yield the responsibilities without an owner; those that the spec does not mention in one finding."""
    stated, others = _open(graph, "responsibility")
    for item in stated:
        yield found(graph, item.path, f"`{item.name}` has no owner")
    if others:
        yield found(graph, ("owners", "responsibilities"), f"no owner for {others}")


def _open(graph: CellGraph, kind: str) -> tuple[list[Responsibility], str]:
    """Return what the spec mentions and no owner has, and the names of what it does not mention."""
    items = [item for item in graph.responsibilities.of_kind(kind) if item.open]
    stated = [item for item in items if graph.cell.states(*item.path)]
    return stated, ", ".join(f"`{item.name}`" for item in items if item not in stated)


_ALIKE = 0.8
_SHORTEST = 4


@rule(Severity.WARNING)
def misspelled_owner(graph: CellGraph) -> Findings:
    """Yield owners that are named once and differ by a letter or two from one that is named more often."""
    named = [(owner, path) for owner, path in _owners(graph) if owner != UNKNOWN]
    times = Counter(owner for owner, _ in named)
    usual = [owner for owner, count in times.items() if count > 1]
    for owner, path in named:
        if times[owner] > 1 or len(owner) < _SHORTEST:
            continue
        near = next(
            (text for text in usual if SequenceMatcher(None, owner.lower(), text.lower()).ratio() >= _ALIKE), None
        )
        if near is not None:
            message = f"owner `{owner}` is named once, and `{near}` {times[near]} times"
            yield found(graph, path, message, meant(owner, [near]))


def _owners(graph: CellGraph) -> Iterator[tuple[str, YamlPath]]:
    """Yield every name of an owner with its place."""
    cell = graph.cell
    for duty, owner in cell.owners.responsibilities:
        yield owner, ("owners", "responsibilities", duty)
    for area, owner in cell.owners.approvals:
        yield owner, ("owners", "approvals", area)
    yield from ((node.owner, (*node.path, "owner")) for node in cell.nodes if node.source is NodeSource.SPEC)
    yield from ((calibration.owner, (*calibration.path, "owner")) for calibration in cell.calibrations.values())
    yield cell.safety.recovery.owner, ("safety", "recovery", "owner")
    yield cell.safety.recovery.observer, ("safety", "recovery", "observer")


@rule(Severity.BLOCKER)
def node_without_owner(graph: CellGraph) -> Findings:
    """Yield nodes of the spec without an owner."""
    for item in graph.responsibilities.of_kind("node"):
        if item.open:
            yield found(graph, item.path, f"node `{item.name}` has no owner")
