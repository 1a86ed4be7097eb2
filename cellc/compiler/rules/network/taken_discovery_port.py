"""The port of a discovery server is taken by something else.

The second process that binds a port does not start. Where it is the server, no node of the cell finds another; where it
is a node, that node is missing, on some starts and not on others.

Example that is reported:

```yaml
network: {domain_id: 17, discovery: server, servers: [{host: control_pc, port: 11811}]}  # expect at port
```

Example that is accepted:

```yaml
network: {domain_id: 42, discovery: server, servers: [{host: control_pc, port: 11811}]}
```

Fix: state another port, or another domain, whose ports are 7400 + 250 × id and the 249 after it.

Source: https://fast-dds.docs.eprosima.com/en/v2.14.4/fastdds/transport/listening_locators.html
(2.14.4): well known ports; DDSI-RTPS 2.5, 9.6.1
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_FIRST, _EACH = 7400, 250
"""Ports of domain 0 begin at the first, and each domain has so many."""


@rule(Severity.ERROR, assumes=("domain-id-out-of-range",))
def check(graph: CellGraph) -> Findings:
    """Yield ports of servers in the range of the cell's domain, of a driver's, or of a server before."""
    network = graph.cell.network
    begin = _FIRST + _EACH * network.domain_id
    taken = {
        (device.host, port): f"the driver of `{device.name}`"
        for device in graph.cell.devices
        for port in (() if device.network is None else device.network.listens)
    }
    for number, server in enumerate(network.servers):
        path = ("network", "servers", number, "port")
        owner = taken.setdefault((server.host, server.port), f"`servers` {number}")
        if begin <= server.port < begin + _EACH:
            owner = f"domain {network.domain_id}, {begin} to {begin + _EACH - 1}"
        if owner != f"`servers` {number}":
            yield found(graph, path, f"{server.port} on `{server.host}` must be free for a server, got one of {owner}")
