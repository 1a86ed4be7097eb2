"""Which network cards of a host carry ROS, and the profiles of Cyclone DDS, Fast DDS and Zenoh that say so.

A card for control carries the vendor's protocol and nothing else: it is left out of every list here, so that no image
and no bag reaches it. Cyclone DDS: only elements that 0.10.5 and 11.0.1 share, because an element that a version does
not know makes the domain fail. Fast DDS: UDP on the listed cards alone, shared memory in the host; without multicast
the profile says all of discovery, because rmw_fastrtps 9.2.0 adds a second UDP transport on every card for LOCALHOST,
and none for SYSTEM_DEFAULT (rmw_fastrtps_shared_cpp/src/participant.cpp:184-213). Zenoh: a router
on the listed cards, sessions that know it alone; it has no discovery range, so that who is not connected to the router
is not in the cell. Values that rmw_zenoh sets in its own files, timestamps and the long query time among them, stand
here too, because these files take their place.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.formats.xml_text import element
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.network import Nic
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Feature, features

_LOOPBACK = "127.0.0.1"

# A peer without a port is asked at the ports of so many processes: 4 is the default of Fast DDS, 32 that of the rmws.
_MOST_PROCESSES = "99"
_UDP, _SHARED = "cell_udp", "cell_shared_memory"
# Fast DDS 2 and 3 name the same elements under different namespaces.
_OLD_NAMESPACE = "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"
_NAMESPACE = "http://www.eprosima.com"
_PORT = 7447
_SCOUTING = "  scouting: {\n    multicast: { enabled: false },\n    gossip: { enabled: true },\n  },\n"
_TIMES = (
    "  timestamping: { enabled: { router: true, peer: true, client: true } },\n  queries_default_timeout: 600000,\n"
)


@dataclass(frozen=True, slots=True)
class Binding:
    """Where the ROS traffic of one host goes.

    Args:
        addresses: IPv4 addresses of its own cards for ROS, the loopback first.
        peers: addresses of other hosts, for unicast discovery.
        servers: address and port of each discovery server of the cell, where there are any.
        runs: numbers of those that run on this host.
    """

    host: str
    addresses: tuple[str, ...]
    peers: tuple[str, ...]
    servers: tuple[tuple[str, int], ...] = ()
    runs: tuple[int, ...] = ()


def bindings(graph: CellGraph) -> tuple[Binding, ...]:
    """Return one binding a host, in the order of the spec."""
    network = graph.cell.network
    remote = network.discovery in ("multicast", "unicast", "server")
    servers = _servers(graph) if network.discovery == "server" else ()
    bindings: list[Binding] = []
    cards = {host: _cards(graph, host) for host in graph.cell.hosts} if remote else {}
    for host in graph.cell.hosts:
        others = (address for other, own in cards.items() if other != host for address in own)
        peers = (*others, *network.peers) if network.discovery == "unicast" else ()
        runs = tuple(number for number, server in enumerate(network.servers) if server.host == host) if servers else ()
        bindings.append(Binding(host, (_LOOPBACK, *cards.get(host, ())), tuple(dict.fromkeys(peers)), servers, runs))
    return tuple(bindings)


def origins(binding: Binding) -> tuple[str, ...]:
    """Return the places of the spec that the files of a host come from."""
    return f"hosts.{binding.host}", "network", "versions.rmw"


def _servers(graph: CellGraph) -> tuple[tuple[str, int], ...]:
    """Return where the servers listen: on a card for ROS, or in their host alone where it has none."""
    cards = [(graph.network.card_of(server), server.port) for server in graph.cell.network.servers]
    return tuple((_LOOPBACK if card is None else _address(card), port) for card, port in cards)


def _cards(graph: CellGraph, host: str) -> tuple[str, ...]:
    return tuple(_address(card) for card in graph.network.ros_cards(host))


def _address(card: Nic) -> str:
    return card.text.partition("/")[0]


def cyclone_profile(cell: Cell, binding: Binding) -> Element:
    """Return the configuration of the cell's domain on a host."""
    domain = {"Id": str(cell.network.domain_id)}
    parts = [*_general(cell, binding), *_discovery(cell, binding)]
    return element("CycloneDDS", {"xmlns": "https://cdds.io/config"}, [element("Domain", domain, parts)])


def _general(cell: Cell, binding: Binding) -> Iterator[Element]:
    cards = [element("NetworkInterface", {"address": address}) for address in binding.addresses]
    multicast = "true" if cell.network.discovery == "multicast" else "false"
    yield element(
        "General",
        children=[element("Interfaces", children=cards), element("AllowMulticast", text=multicast)],
    )


def _discovery(cell: Cell, binding: Binding) -> Iterator[Element]:
    if cell.network.discovery == "multicast":
        return
    # Where there is ROS_STATIC_PEERS, the middleware adds its peers itself.
    peers = () if Feature.STATIC_PEERS in features(cell.distro) else binding.peers
    listed = [element("Peer", {"Address": address}) for address in (*binding.addresses[:1], *peers)]
    yield element(
        "Discovery",
        children=[
            element("ParticipantIndex", text="auto"),
            element("MaxAutoParticipantIndex", text=_MOST_PROCESSES),
            element("Peers", children=listed),
        ],
    )


def fast_profile(cell: Cell, binding: Binding) -> Element:
    """Return the default profile of every participant on a host."""
    namespace = _NAMESPACE if Feature.FAST_DDS_3 in features(cell.distro) else _OLD_NAMESPACE
    return element(
        "dds", {"xmlns": namespace}, [element("profiles", children=[_transports(cell, binding), _all(cell, binding)])]
    )


def _transports(cell: Cell, binding: Binding) -> Element:
    # interfaceWhiteList is the one list that every supported version reads.
    cards = element("interfaceWhiteList", children=[element("address", text=a) for a in binding.addresses])
    searched = cell.network.discovery not in ("multicast", "server")
    asked = () if not searched else (element("maxInitialPeersRange", text=_MOST_PROCESSES),)
    udp = [element("transport_id", text=_UDP), element("type", text="UDPv4"), *asked, cards]
    shared = [element("transport_id", text=_SHARED), element("type", text="SHM")]
    return element(
        "transport_descriptors",
        children=[element("transport_descriptor", children=udp), element("transport_descriptor", children=shared)],
    )


def _all(cell: Cell, binding: Binding) -> Element:
    used = [element("transport_id", text=name) for name in (_SHARED, _UDP)]
    rtps = [
        *_found_by(cell, binding),
        element("userTransports", children=used),
        element("useBuiltinTransports", text="false"),
    ]
    return element(
        "participant",
        {"profile_name": "cell", "is_default_profile": "true"},
        [element("rtps", children=rtps)],
    )


def _found_by(cell: Cell, binding: Binding) -> Iterator[Element]:
    if binding.servers:
        yield element("builtin", children=[_of_servers(cell, binding)])
    if cell.network.discovery not in ("unicast", "localhost"):
        return
    locators = [
        element("locator", children=[element("udpv4", children=[element("address", text=address)])])
        for address in (*binding.addresses[:1], *binding.peers)
    ]
    # One unicast locator, of no address, and no multicast group is joined.
    unicast = element("metatrafficUnicastLocatorList", children=[element("locator", children=[element("udpv4")])])
    yield element("builtin", children=[unicast, element("initialPeersList", children=locators)])


def _of_servers(cell: Cell, binding: Binding) -> Element:
    """Return what makes every participant a super client, which hears of all others: gates list the whole graph."""
    locators = [_locator(address, port) for address, port in binding.servers]
    # Fast DDS 2 knows a server by a prefix with its number in the third octet, 3 by its address alone.
    if Feature.FAST_DDS_3 not in features(cell.distro):
        locators = [
            element(
                "RemoteServer",
                {"prefix": f"44.53.{number:02x}.5f.45.50.52.4f.53.49.4d.41"},
                [element("metatrafficUnicastLocatorList", children=[locator])],
            )
            for number, locator in enumerate(locators)
        ]
    parts = [element("discoveryProtocol", text="SUPER_CLIENT"), element("discoveryServersList", children=locators)]
    return element("discovery_config", children=parts)


def _locator(address: str, port: int) -> Element:
    parts = [element("address", text=address), element("port", text=str(port))]
    return element("locator", children=[element("udpv4", children=parts)])


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
