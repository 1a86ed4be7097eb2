"""Configuration of Zenoh: a router on the listed cards, sessions that know it alone.

Zenoh has no discovery range: who is not connected to the router is not in the cell. Values that rmw_zenoh sets in its
own files, timestamps and the long query time among them, stand here too, because these files take their place.
"""

from __future__ import annotations

import json

from cellc.emit.middleware.binding import Binding

_PORT = 7447
_SCOUTING = "  scouting: {\n    multicast: { enabled: false },\n    gossip: { enabled: true },\n  },\n"
_TIMES = (
    "  timestamping: { enabled: { router: true, peer: true, client: true } },\n  queries_default_timeout: 600000,\n"
)


def zenoh_router(binding: Binding) -> str:
    """Return the configuration of the host's router."""
    return _document("router", listen=_endpoints(binding.addresses), connect=_endpoints(binding.peers))


def zenoh_session() -> str:
    """Return the configuration of every node's session."""
    return _document("peer", listen=["tcp/localhost:0"], connect=[f"tcp/localhost:{_PORT}"])


def _document(mode: str, *, listen: list[str], connect: list[str]) -> str:
    return (
        "{\n"
        f'  mode: "{mode}",\n'
        f"  connect: {{ endpoints: {json.dumps(connect)} }},\n"
        f"  listen: {{ endpoints: {json.dumps(listen)} }},\n"
        f"{_SCOUTING}{_TIMES}"
        "}\n"
    )


def _endpoints(addresses: tuple[str, ...]) -> list[str]:
    return [f"tcp/{address}:{_PORT}" for address in addresses]
