"""A host does not reach the discovery server.

A participant that cannot reach the server finds no other and is found by none. It retries silently, forever. A server
listens on one card, and never on that of the robot.

Example that is reported:

```yaml
# a cell of two computers
network: {discovery: server, servers: [{host: control_pc, nic: robot}]}  # expect at 0.nic
```

Example that is accepted:

```yaml
# a cell of two computers
network: {discovery: server, servers: [{host: control_pc, nic: cell}]}
```

Fix: name a host of the cell, and a card of it in the subnet of the others that carries no control.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Discovery-Server/Discovery-Server.html
(Jazzy): clients connect to the address of the server
"""

from __future__ import annotations

from cellc.compiler.cell.site import DiscoveryServer
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR, assumes=("malformed-address",))
def check(graph: CellGraph) -> Findings:
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
            message = f"{wanted} must have an address and carry no control, as a discovery server listens on it"
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
