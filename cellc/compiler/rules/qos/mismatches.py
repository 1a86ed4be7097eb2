"""Rules on what is requested against what is offered."""

from __future__ import annotations

from cellc.compiler.graph.data_flow import TopicPair
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule, rules


def _unmatched(graph: CellGraph) -> tuple[TopicPair, ...]:
    return tuple(graph.data.unmatched())


def _mismatched(graph: CellGraph, policy: str) -> Findings:
    """Yield a finding at each subscriber that requests more of a policy than one publisher of its topic offers."""
    for pair in graph.once(_unmatched):
        source, sink = pair.source, pair.sink
        for row in pair.rows:
            if row.policy == policy:
                message = (
                    f"`{sink.node}` requests `{policy}: {row.requested}` on `{pair.topic.name}`, "
                    f"`{source.node}` offers `{row.offered}`"
                )
                yield found(graph, sink.path, message, related=(Related("offered here", source.span),))


MISMATCHES = rules(
    Severity.ERROR,
    _mismatched,
    {
        "deadline-mismatch": "deadline",
        "durability-mismatch": "durability",
        "lease-mismatch": "lease_duration",
        "liveliness-mismatch": "liveliness",
        "reliability-mismatch": "reliability",
    },
)


@rule(Severity.WARNING)
def qos_ignored_by_rmw(graph: CellGraph) -> Findings:
    """Yield endpoints that set a policy which Zenoh does not monitor."""
    if not graph.cell.versions.rmw.startswith("rmw_zenoh"):
        return
    for topic in graph.cell.interfaces:
        for end in (*topic.sources, *topic.sinks):
            watched = (("deadline", end.qos.deadline_s), ("lease_duration", end.qos.lease_duration_s))
            field = next((field for field, value in watched if value is not None), None)
            if field is not None and not topic.derived:
                message = f"`{end.node}` sets `{field}` on `{topic.name}`, which Zenoh does not monitor"
                yield found(graph, (*end.path, field), message)


@rule(Severity.WARNING)
def policy_without_effect(graph: CellGraph) -> Findings:
    """Yield policies that are written at an end which does not read them."""
    for topic in graph.cell.interfaces:
        if topic.derived:
            continue
        for end in topic.sinks:
            if graph.cell.states(*end.path, "lifespan"):
                message = f"`lifespan` changes nothing at `{end.node}`, which reads `{topic.name}`"
                yield found(graph, (*end.path, "lifespan"), message, "state it at the publisher")
        for end in (*topic.sources, *topic.sinks):
            if end.qos.history == "keep_all" and graph.cell.states(*end.path, "depth"):
                message = f"`depth` changes nothing at `{end.node}`, which keeps all of `{topic.name}`"
                yield found(graph, (*end.path, "depth"), message, "delete it, or write `history: keep_last`")
