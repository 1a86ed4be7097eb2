"""How the rules of QoS find the subscribers that request more than their publishers offer."""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, found
from cellc.contract.qos import incompatibilities


def weak_offers(graph: CellGraph, policy: str) -> Findings:
    """Yield a finding at each subscriber that requests more of a policy than one publisher of its topic offers."""
    for pair in graph.data.topic_pairs():
        source, sink = pair.source, pair.sink
        for row in incompatibilities(source.qos, sink.qos):
            if row.policy == policy:
                message = (
                    f"`{sink.node}` requests `{policy}: {row.requested}` on `{pair.topic.name}`, "
                    f"`{source.node}` offers `{row.offered}`"
                )
                yield found(graph, sink.path, message, related=(Related("offered here", source.span),))
