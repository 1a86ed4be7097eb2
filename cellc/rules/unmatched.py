"""How the rules of QoS find the pairs of a topic that the middleware will not connect."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.cell.interface import Qos
from cellc.diagnostics import Related
from cellc.graph.cell_graph import CellGraph
from cellc.graph.data_flow import TopicPair
from cellc.rule import Finding
from cellc.rules.finding import found


def unmatched(
    graph: CellGraph,
    refused: Callable[[Qos, Qos], bool],
    message: Callable[[TopicPair], str],
    advice: str,
) -> Iterator[Finding]:
    """Yield a finding at each subscriber of a topic that asks for more than one of its publishers offers.

    Args:
        refused: whether one policy, offered and requested, keeps a pair from being connected.
        message: says what the pair disagrees on.
        advice: how to mend it.
    """
    for pair in graph.data.topic_pairs():
        if refused(pair.source.qos, pair.sink.qos):
            related = (Related("offered here", pair.source.span),)
            yield found(graph, pair.sink.path, message(pair), advice, related)


def longer(offered_s: float | None, requested_s: float | None) -> bool:
    """Tell whether an offered duration exceeds the requested one; None is infinite."""
    return requested_s is not None and (offered_s is None or offered_s > requested_s)
