"""The presence of a cell whose graph is built."""

from __future__ import annotations

from cellc.fleet.presence import Presence
from cellc.graph.cell_graph import CellGraph


def presence_of(graph: CellGraph) -> Presence:
    """Return how the other cells of a site meet this one."""
    cell = graph.cell
    network = cell.spec.network
    return Presence(
        name=cell.name,
        named_at=cell.locate("cell"),
        domain_id=network.domain_id,
        discovery=network.discovery,
        cards=tuple(str(nic.interface) for nic in graph.network.nics if nic.interface is not None),
        peers=network.peers,
        domain_at=cell.locate("network", "domain_id"),
    )
