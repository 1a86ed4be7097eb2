"""How old observations are at the end of their chains, with the time in executors, and what of it is not stated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Interface, Node, NodeSource
from cellc.compiler.formats.escape import code
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.graph.data_flow import AgeShare, age_chains
from cellc.compiler.graph.executors import response
from cellc.compiler.graph.time_pairs import shown


def ages_section(cell: Cell) -> str:
    """Write each topic with an age limit, the sum of what its age is made of, and what is not in the sum."""
    topics = {topic.name: topic for topic in cell.interfaces}
    nodes = {node.full_name: node for node in cell.nodes if node.source is NodeSource.SPEC}
    rows = (
        (
            code(name),
            shown(topics[name].max_age_s or 0.0),
            _sum(shares),
            "; ".join(
                _left_out(
                    cell, [topics[share.topic] for share in shares if share.response_s is None], topics[name], nodes
                )
            )
            or "nothing",
        )
        for name, shares in age_chains(cell).items()
        if name in topics and not topics[name].derived and topics[name].max_age_s is not None
    )
    return table(("topic", "allowed", "end to end", "not in it"), rows)


def _sum(shares: tuple[AgeShare, ...]) -> str:
    parts = " + ".join(f"{code(share.topic)} {shown(share.total_s)}" for share in shares)
    return f"{shown(sum(share.total_s for share in shares))}: {parts}"


def _left_out(cell: Cell, way: list[Interface], last: Interface, nodes: Mapping[str, Node]) -> Iterator[str]:
    """Yield the nodes on the way, and at its end, of which the spec does not say how long a sample takes."""
    hearing = [(topic, {source.node for source in after.sources}) for topic, after in pairwise(way)]
    for topic, wanted in (*hearing, (last, {sink.node for sink in last.sinks})):
        for sink in topic.sinks:
            node = nodes.get(sink.full_name) if sink.node in wanted else None
            if node is not None and (answer := response(cell, node, topic.name)).bound_s is None:
                yield f"time in {code(sink.node)} is UNKNOWN: {answer.why}"
