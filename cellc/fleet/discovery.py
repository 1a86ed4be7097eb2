"""Whether the participants of two cells discover each other."""

from __future__ import annotations

from ipaddress import IPv4Interface

from cellc.fleet.presence import Presence

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
    named = sorted(
        {str(card.ip) for card in ours} & set(second.peers) | {str(card.ip) for card in theirs} & set(first.peers)
    )
    return f"through the peer {named[0]}" if named else None


def _interfaces(cell: Presence) -> list[IPv4Interface]:
    return [IPv4Interface(card) for card in cell.cards]


def _addresses(cards: list[IPv4Interface]) -> set[str]:
    return {str(card.ip) for card in cards}
