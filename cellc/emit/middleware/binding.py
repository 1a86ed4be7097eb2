"""Which network cards of a host carry ROS, and which other hosts it talks to.

A card for control carries the vendor's protocol and nothing else: it is left out of every list here, so that no image
and no bag reaches it.
"""

from __future__ import annotations

from dataclasses import dataclass

from cellc.graph.cell_graph import CellGraph

LOOPBACK = "127.0.0.1"


@dataclass(frozen=True, slots=True)
class Binding:
    """Where the ROS traffic of one host goes.

    Args:
        addresses: IPv4 addresses of its own cards for ROS, the loopback first.
        peers: addresses of other hosts, for unicast discovery.
    """

    host: str
    addresses: tuple[str, ...]
    peers: tuple[str, ...]


def bindings(graph: CellGraph) -> tuple[Binding, ...]:
    """Return one binding a host, in the order of the spec."""
    network = graph.cell.spec.network
    remote = network.discovery in ("multicast", "unicast")
    found: list[Binding] = []
    for host in graph.cell.spec.hosts:
        own = _cards(graph, host) if remote else ()
        others = [address for other in graph.cell.spec.hosts if other != host for address in _cards(graph, other)]
        peers = (*others, *network.peers) if network.discovery == "unicast" else ()
        found.append(Binding(host, (LOOPBACK, *own), tuple(dict.fromkeys(peers))))
    return tuple(found)


def origins(binding: Binding) -> tuple[str, ...]:
    """Return the places of the spec that the files of a host come from."""
    return f"hosts.{binding.host}", "network", "versions.rmw"


def _cards(graph: CellGraph, host: str) -> tuple[str, ...]:
    return tuple(
        str(nic.interface.ip)
        for nic in graph.network.nics
        if nic.host == host and nic.interface is not None and "control" not in nic.carries
    )
