"""What a publisher must offer for what a subscriber requests: one row per QoS policy that the middleware compares."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cellc.cell.interface import Qos
from cellc.graph.data_flow import TopicPair
from cellc.rules.kit import CellGraph, Findings, Related, found


@dataclass(frozen=True, slots=True)
class _Policy:
    """When an offer is too weak for a request, and how the disagreement is said."""

    refuses: Callable[[Qos, Qos], bool]
    message: Callable[[TopicPair], str]


def weak_offers(graph: CellGraph, policy: str) -> Findings:
    """Yield a finding at each subscriber that requests more of a policy than one publisher of its topic offers."""
    row = _POLICIES[policy]
    for pair in graph.data.topic_pairs():
        if row.refuses(pair.source.qos, pair.sink.qos):
            related = (Related("offered here", pair.source.span),)
            yield found(graph, pair.sink.path, row.message(pair), related=related)


def _longer(offered_s: float | None, requested_s: float | None) -> bool:
    """Tell whether an offered duration exceeds the requested one; None is infinite."""
    return requested_s is not None and (offered_s is None or offered_s > requested_s)


def _seconds(duration_s: float | None) -> str:
    return "none" if duration_s is None else f"{duration_s:g} s"


def _requests(pair: TopicPair, requested: str, offered: str) -> str:
    return f"`{pair.sink.node}` requests {requested} on `{pair.topic.name}`, `{pair.source.node}` offers {offered}"


_POLICIES = {
    "reliability": _Policy(
        lambda offered, requested: (offered.reliability, requested.reliability) == ("best_effort", "reliable"),
        lambda pair: _requests(pair, "reliability reliable", "best_effort"),
    ),
    "durability": _Policy(
        lambda offered, requested: (offered.durability, requested.durability) == ("volatile", "transient_local"),
        lambda pair: _requests(pair, "durability transient_local", "volatile"),
    ),
    "deadline": _Policy(
        lambda offered, requested: _longer(offered.deadline_s, requested.deadline_s),
        lambda pair: _requests(
            pair, f"a deadline of {_seconds(pair.sink.qos.deadline_s)}", _seconds(pair.source.qos.deadline_s)
        ),
    ),
    "liveliness": _Policy(
        lambda offered, requested: (offered.liveliness, requested.liveliness) == ("automatic", "manual_by_topic"),
        lambda pair: _requests(pair, "liveliness manual_by_topic", "automatic"),
    ),
    "lease_duration": _Policy(
        lambda offered, requested: _longer(offered.lease_duration_s, requested.lease_duration_s),
        lambda pair: _requests(
            pair,
            f"a lease_duration of {_seconds(pair.sink.qos.lease_duration_s)}",
            _seconds(pair.source.qos.lease_duration_s),
        ),
    ),
}
