"""Rules on what is requested against what is offered."""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.compiler.rules.qos_offers import weak_offers


@rule(Severity.ERROR)
def deadline_mismatch(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "deadline")


@rule(Severity.ERROR)
def durability_mismatch(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "durability")


@rule(Severity.ERROR)
def lease_mismatch(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "lease_duration")


@rule(Severity.ERROR)
def liveliness_mismatch(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "liveliness")


@rule(Severity.WARNING)
def qos_ignored_by_rmw(graph: CellGraph) -> Findings:
    """Yield endpoints that set a policy which Zenoh does not watch."""
    if not graph.cell.versions.rmw.startswith("rmw_zenoh"):
        return
    for topic in graph.cell.interfaces:
        for end in (*topic.sources, *topic.sinks):
            watched = (("deadline", end.qos.deadline_s), ("lease_duration", end.qos.lease_duration_s))
            field = next((field for field, value in watched if value is not None), None)
            if field is not None and not topic.derived:
                message = f"`{end.node}` sets `{field}` on `{topic.name}`, which Zenoh does not watch"
                yield found(graph, (*end.path, field), message)


@rule(Severity.ERROR)
def reliability_mismatch(graph: CellGraph) -> Findings:
    """Yield subscribers that request more than their publisher offers."""
    return weak_offers(graph, "reliability")
