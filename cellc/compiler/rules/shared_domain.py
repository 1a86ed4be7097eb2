"""Cells of one call that discover each other without meaning to: the one check that compares several cells."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from ipaddress import IPv4Interface
from typing import TYPE_CHECKING

from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span
from cellc.contract.frozen import dataclass

if TYPE_CHECKING:
    from cellc.compiler.graph.cell_graph import CellGraph


@dataclass(frozen=True, slots=True)
class Presence:
    """A cell as its neighbors see it.

    Args:
        name: of the cell, and so of its folder.
        named_at: where the spec gives the name.
        domain_id: ROS_DOMAIN_ID.
        discovery: `multicast`, `unicast`, `server`, `localhost` or `off`.
        cards: well-formed addresses of the hosts' network cards with their prefix lengths, such as `10.10.0.10/24`.
        peers: static peers, as they stand in the spec.
        servers: addresses and ports of discovery servers.
        domain_at: where the spec gives the domain, or its network.
    """

    name: str
    named_at: Span
    domain_id: int
    discovery: str
    cards: tuple[str, ...]
    peers: tuple[str, ...]
    domain_at: Span
    servers: frozenset[str] = frozenset()


def presence_of(graph: CellGraph) -> Presence:
    """Return how the other cells of a site meet this one."""
    cell = graph.cell
    network = cell.network
    return Presence(
        name=cell.name,
        named_at=cell.locate("cell"),
        domain_id=network.domain_id,
        discovery=network.discovery,
        cards=tuple(str(nic.interface) for nic in graph.network.nics if nic.interface is not None),
        peers=network.peers,
        servers=frozenset(
            f"{card.interface.ip}:{server.port}"
            for server in network.servers
            if (card := graph.network.card_of(server)) is not None and card.interface is not None
        ),
        domain_at=cell.locate("network", "domain_id"),
    )


def shared_domains(cell: Presence, earlier: Sequence[Presence]) -> Iterator[Diagnostic]:
    """Report the first earlier cell of the call whose nodes would talk to this one's."""
    for other in earlier:
        way = way_between(other, cell)
        if way is not None:
            yield Diagnostic(
                "shared-domain-id",
                Severity.ERROR,
                f"`{cell.name}` and `{other.name}` use domain {cell.domain_id} and discover each other {way}",
                cell.domain_at,
                ("network", "domain_id"),
                "give each cell a domain of its own, from 0 to 101",
                (Related(f"`{other.name}` has it here", other.domain_at),),
            )
            return


_LOCAL = ("localhost", "off")
"""Modes of discovery in which no packet leaves the host."""


def way_between(first: Presence, second: Presence) -> str | None:
    """Say how participants of two cells discover each other; None where they do not.

    Cells that share an address run on one computer and are taken for variants of one cell.
    """
    if first.domain_id != second.domain_id or first.discovery in _LOCAL or second.discovery in _LOCAL:
        return None
    ours, theirs = _interfaces(first), _interfaces(second)
    if _addresses(ours) & _addresses(theirs):
        return None
    if first.discovery == second.discovery == "multicast":
        shared = sorted({str(a.network) for a in ours for b in theirs if a.network.overlaps(b.network)})
        return f"by multicast in {shared[0]}" if shared else None
    if "server" in (first.discovery, second.discovery):  # who asks a server does not listen to multicast
        common = sorted(first.servers & second.servers) if first.discovery == second.discovery else []
        return f"through the server {common[0]}" if common else None
    named = sorted(
        {str(card.ip) for card in ours} & set(second.peers) | {str(card.ip) for card in theirs} & set(first.peers)
    )
    return f"through the peer {named[0]}" if named else None


def _interfaces(cell: Presence) -> list[IPv4Interface]:
    return [IPv4Interface(card) for card in cell.cards]


def _addresses(cards: list[IPv4Interface]) -> set[str]:
    return {str(card.ip) for card in cards}
