"""How a cell is met by the other cells of a site: its name, its domain, and the addresses of its hosts."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.diagnostics import Span


@dataclass(frozen=True, slots=True)
class Presence:
    """A cell as its neighbours see it.

    Args:
        name: of the cell, and so of its folder.
        named_at: where the spec gives the name.
        domain_id: ROS_DOMAIN_ID.
        discovery: `multicast`, `unicast`, `localhost` or `off`.
        cards: well-formed addresses of the hosts' network cards with their prefix lengths, such as `10.10.0.10/24`.
        peers: static peers, as they stand in the spec.
        domain_at: where the spec gives the domain, or its network.
    """

    name: str
    named_at: Span
    domain_id: int
    discovery: str
    cards: tuple[str, ...]
    peers: tuple[str, ...]
    domain_at: Span
