"""The pinned middleware does not know this kind of discovery.

Zenoh discovers through its router and ignores the variables of DDS: the cell is not confined as the spec says. A
discovery server is a program of Fast DDS, and no other middleware asks one.

Example that is reported:

```yaml
versions: {rmw: rmw_zenoh_cpp 0.2.10}
network: {discovery: localhost}  # expect at discovery
```

Example that is accepted:

```yaml
versions: {rmw: rmw_zenoh_cpp 0.2.10}
network: {discovery: multicast}
```

Fix: leave `discovery` at its default for Zenoh, and list `peers` for Cyclone DDS instead of a server.

Source:

- https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html (Jazzy): not supported by rmw_zenoh
- https://docs.ros.org/en/jazzy/Tutorials/Advanced/Discovery-Server/Discovery-Server.html (Jazzy): of Fast DDS
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a discovery range, peers or a server with a middleware that ignores them."""
    network, rmw = graph.cell.network, graph.cell.versions.rmw_name
    if rmw == "rmw_cyclonedds_cpp" and network.discovery == "server":
        yield found(graph, ("network", "discovery"), "Cyclone DDS must have its peers, and asks no discovery server")
    if not rmw.startswith("rmw_zenoh"):
        return
    if network.discovery != "multicast" or network.peers:
        field = "discovery" if network.discovery != "multicast" else "peers"
        yield found(graph, ("network", field), f"Zenoh ignores `{field}`")
