"""The pinned middleware does not know this kind of discovery.

Zenoh discovers through its router and ignores the variables of DDS: the cell is not confined as the spec says.

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

Fix: configure the router and the session of Zenoh instead, and leave `discovery` at its default.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html
(Jazzy): rmw_zenoh does not support the variables
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a discovery range or peers with a middleware that ignores them."""
    network = graph.cell.network
    if not graph.cell.versions.rmw.startswith("rmw_zenoh"):
        return
    if network.discovery != "multicast" or network.peers:
        field = "discovery" if network.discovery != "multicast" else "peers"
        yield found(graph, ("network", field), f"Zenoh ignores `{field}`")
