"""Rules on how the nodes of a cell find each other."""

from __future__ import annotations

from cellc.compiler.graph.enclaves import enclaves
from cellc.compiler.graph.network import Nic, read_address
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule
from cellc.contract.stated import DiscoveryServer


@rule(Severity.ERROR)
def discovery_off(graph: CellGraph) -> Findings:
    """Yield discovery that is off in a cell of one host or none."""
    if graph.cell.network.discovery == "off" and len(graph.cell.hosts) < 2:
        message = "discovery is off, so no two processes of the cell discover each other"
        yield found(graph, ("network", "discovery"), message)


@rule(Severity.ERROR)
def discovery_unknown_to_rmw(graph: CellGraph) -> Findings:
    """Yield a discovery range, peers or a server with a middleware that ignores them."""
    network, rmw = graph.cell.network, graph.cell.versions.rmw_name
    if rmw == "rmw_cyclonedds_cpp" and network.discovery == "server":
        yield found(
            graph,
            ("network", "discovery"),
            "`discovery` must be `multicast` or `unicast` with Cyclone DDS, got `server`",
        )
    if not rmw.startswith("rmw_zenoh"):
        return
    if network.discovery != "multicast" or network.peers:
        field = "discovery" if network.discovery != "multicast" else "peers"
        yield found(graph, ("network", field), f"`{field}` has no effect with Zenoh")


_READS = {"peers": "unicast", "servers": "server"}


@rule(Severity.WARNING, assumes=("discovery-unknown-to-rmw",))
def discovery_without_effect(graph: CellGraph) -> Findings:
    """Yield lists that the chosen discovery does not read."""
    network = graph.cell.network
    for key, kind in _READS.items():
        if getattr(network, key) and network.discovery != kind:
            message = f"`{key}` must have `discovery: {kind}`, got `{network.discovery}`"
            yield found(graph, ("network", key), message)


_LARGEST_DOMAIN = 232


@rule(Severity.ERROR)
def domain_id_out_of_range(graph: CellGraph) -> Findings:
    """Yield a domain outside 0 to 232."""
    domain = graph.cell.network.domain_id
    if not 0 <= domain <= _LARGEST_DOMAIN:
        message = f"`domain_id` must be between 0 and {_LARGEST_DOMAIN}, got {domain}"
        yield found(graph, ("network", "domain_id"), message)


_EPHEMERAL = range(102, 215)


@rule(Severity.WARNING)
def domain_in_ephemeral_ports(graph: CellGraph) -> Findings:
    """Yield a domain whose ports are ephemeral ones."""
    domain = graph.cell.network.domain_id
    if domain in _EPHEMERAL:
        message = f"the ports of domain {domain} are ephemeral ports of Linux"
        yield found(graph, ("network", "domain_id"), message)


_LONGEST_ENCLAVE = 64
"""Characters of a common name: RFC 5280, ub-common-name."""


@rule(Severity.WARNING)
def enclave_too_long(graph: CellGraph) -> Findings:
    """Yield enclaves that no certificate can name; a middleware without SROS2 has no enclaves."""
    if graph.cell.versions.rmw.startswith("rmw_zenoh"):
        return
    for name, path in enclaves(graph.cell):
        if len(name) > _LONGEST_ENCLAVE:
            message = f"enclave `{name}` must have at most {_LONGEST_ENCLAVE} characters, got {len(name)}"
            yield found(graph, path, message)


@rule(Severity.ERROR)
def localhost_with_several_hosts(graph: CellGraph) -> Findings:
    """Yield discovery that is bound to the host in a cell of several hosts."""
    discovery, hosts = graph.cell.network.discovery, graph.cell.hosts
    if discovery in ("localhost", "off") and len(hosts) > 1:
        names = " and ".join(f"`{name}`" for name in hosts)
        message = f"discovery is `{discovery}`, but the cell runs on {names}"
        yield found(graph, ("network", "discovery"), message)


@rule(Severity.ERROR)
def missing_discovery_server(graph: CellGraph) -> Findings:
    """Yield discovery by a server in a cell that has none."""
    network = graph.cell.network
    if network.discovery == "server" and not network.servers:
        yield found(
            graph, ("network", "discovery"), "`servers` must name a host, because the nodes use a server, got none"
        )


@rule(Severity.ERROR)
def missing_ros_card(graph: CellGraph) -> Findings:
    """Yield hosts that run nodes and have cards, none of which carries ROS, where another host runs nodes too."""
    running = {node.host for node in graph.cell.nodes} | {manager.host for manager in graph.cell.managers}
    hosts = [host for host in graph.cell.hosts.values() if host.name in running]
    with_card = [host for host in hosts if any("ros" in nic.carries for nic in host.nics.values())]
    if not with_card:
        return
    names = {host.name for host in with_card}
    for host in hosts:
        if host.nics and host.name not in names:
            others = ", ".join(f"`{other.name}`" for other in with_card)
            message = f"`{host.name}` runs nodes and must have a card that carries `ros`, as {others} has"
            related = tuple(Related("nodes of the cell run here too", other.span) for other in with_card)
            related += tuple(
                Related("a card of it", graph.cell.locate("hosts", host.name, "nics", name)) for name in host.nics
            )
            yield found(graph, (*host.path, "nics"), message, related=related)


@rule(Severity.WARNING)
def ros_cards_apart(graph: CellGraph) -> Findings:
    """Yield hosts whose cards for ROS are in no subnet of those of the first host that has one."""
    cards: dict[str, list[Nic]] = {}
    for nic in graph.network.nics:
        if "ros" in nic.carries and nic.interface is not None:
            cards.setdefault(nic.host, []).append(nic)
    seen: list[Nic] = []
    for host, nics in cards.items():
        if seen and not any(_meet(nic, other) for nic in nics for other in seen):
            other = seen[0]
            message = f"`{nics[0].full_name}` must share a subnet with `{other.full_name}`, `{other.text}`,"
            message += f" got `{nics[0].text}`"
            related = (Related("the other card", graph.cell.locate(*other.path, "address")),)
            yield found(graph, ("hosts", host, "nics", nics[0].name, "address"), message, related=related)
        seen += nics


def _meet(one: Nic, other: Nic) -> bool:
    assert one.interface is not None
    assert other.interface is not None
    return one.interface.network.overlaps(other.interface.network)


_FIRST_PORT, _PORTS_EACH, _OF_PARTICIPANTS = 7400, 250, 10
"""Ports of domain 0 begin at the first, each domain has so many, and its participants begin at the last offset."""
_MANY = 30
"""Participants of a computer: more than the programs of a cell with what people start beside them."""


@rule(Severity.ERROR, assumes=("domain-id-out-of-range",))
def taken_discovery_port(graph: CellGraph) -> Findings:
    """Yield ports of servers that the cell's domain takes first, or a driver's, or of a server before."""
    network = graph.cell.network
    taken = {
        (device.site.host, port): f"the driver of `{device.name}`"
        for device in graph.cell.devices
        for port in (() if device.site.network is None else device.site.network.listens)
    }
    for number, server in enumerate(network.servers):
        path = ("network", "servers", number, "port")
        owner = taken.setdefault((server.host, server.port), f"`servers` {number}")
        participant = _participant(network.domain_id, server.port)
        if participant is not None and participant < _MANY:
            which = f"participant {participant}" if participant >= 0 else "every participant"
            owner = f"{which} of domain {network.domain_id}"
        if owner != f"`servers` {number}":
            yield found(graph, path, f"{server.port} on `{server.host}` must be free for a server, got that of {owner}")


@rule(Severity.WARNING, assumes=("domain-id-out-of-range", "taken-discovery-port"))
def discovery_port_of_many(graph: CellGraph) -> Findings:
    """Yield ports of servers that the cell's domain takes only when very many programs run on a computer."""
    network = graph.cell.network
    for number, server in enumerate(network.servers):
        participant = _participant(network.domain_id, server.port)
        if participant is not None and participant >= _MANY:
            whose = f"participant {participant} of domain {network.domain_id}"
            message = f"{server.port} on `{server.host}` should be free for a server, got that of {whose}"
            yield found(graph, ("network", "servers", number, "port"), message)


def _participant(domain_id: int, port: int) -> int | None:
    """Return the number of the participant that has a port, -1 of all; None where none of the domain has it.

    Source: DDSI-RTPS 2.5, 9.6.2.3, with the default parameters: PB 7400, DG 250, PG 2, d0 0, d1 10, d2 1, d3 11.
    """
    offset = port - _FIRST_PORT - _PORTS_EACH * domain_id
    if offset in (0, 1):
        return -1
    return (offset - _OF_PARTICIPANTS) // 2 if _OF_PARTICIPANTS <= offset < _PORTS_EACH else None


@rule(Severity.ERROR)
def unicast_without_peers(graph: CellGraph) -> Findings:
    """Yield unicast discovery of a single host without peers."""
    network = graph.cell.network
    if network.discovery == "unicast" and not network.peers and len(graph.cell.hosts) < 2:
        message = "discovery is unicast, but there is no second host and no peer"
        yield found(graph, ("network", "discovery"), message)


@rule(Severity.WARNING)
def unknown_peer(graph: CellGraph) -> Findings:
    """Yield peers that are IPv4 addresses and no card's; a cell of one host has only peers that it does not know."""
    if len(graph.cell.hosts) < 2:
        return
    cards = [nic.interface.ip for nic in graph.network.nics if nic.interface is not None]
    known = [str(address) for address in cards]
    for number, peer in enumerate(graph.cell.network.peers):
        address = read_address(peer)
        if address is None or address.is_loopback or address in cards:
            continue
        near = any(nic.interface is not None and address in nic.interface.network for nic in graph.network.nics)
        where = "no host has this address" if near else "no host has this address and no card is in its subnet"
        message = f"peer `{peer}` must be the address of a card, but {where}"
        yield found(graph, ("network", "peers", number), message, did_you_mean(peer, known, "addresses of cards"))


@rule(Severity.ERROR, assumes=("malformed-address",))
def unreachable_discovery_server(graph: CellGraph) -> Findings:
    """Yield servers that listen nowhere, or out of reach of a host that has a card for ROS."""
    network, hosts = graph.cell.network, graph.cell.hosts
    for number, server in enumerate(network.servers if network.discovery == "server" else ()):
        path = ("network", "servers", number)
        if server.host not in hosts:
            message = f"a discovery server must run on a host of the cell, got `{server.host}`"
            yield found(graph, (*path, "host"), message, did_you_mean(server.host, list(hosts), "hosts"))
            continue
        card = graph.network.card_of(server)
        place = (*path, "host" if server.nic is None else "nic")
        if card is None and (server.nic is not None or len(hosts) > 1):
            wanted = f"`{server.host}/{server.nic}`" if server.nic else f"a card of `{server.host}`"
            message = f"{wanted} must have an address and carry no control, because a discovery server listens on it"
            yield found(graph, place, message)
            continue
        far = _out_of_reach(graph, server)
        if far:
            message = f"`{'`, `'.join(far)}` must have a card in the subnet of the discovery server on `{server.host}`"
            yield found(graph, place, message)


def _out_of_reach(graph: CellGraph, server: DiscoveryServer) -> list[str]:
    """Return the hosts with a card for ROS that have none in the subnet of the server's."""
    card = graph.network.card_of(server)
    subnet = None if card is None or card.interface is None else card.interface.network
    others = {host: graph.network.ros_cards(host) for host in graph.cell.hosts if host != server.host}
    return [
        host
        for host, cards in others.items()
        if subnet is not None
        and cards
        and not any(nic.interface is not None and nic.interface.network.overlaps(subnet) for nic in cards)
    ]
