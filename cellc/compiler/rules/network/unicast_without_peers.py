"""Unicast discovery has no peers.

Without multicast a participant finds only its listed peers.

Example that is reported:

```yaml
network: {discovery: unicast}  # expect at discovery
```

Example that is accepted:

```yaml
network: {discovery: unicast, peers: [10.10.0.11]}
```

Fix: list the `peers:`, or use `localhost` on a single host.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html (Jazzy): ROS_STATIC_PEERS
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield unicast discovery of a single host without peers."""
    network = graph.cell.network
    if network.discovery == "unicast" and not network.peers and len(graph.cell.hosts) < 2:
        message = "discovery is unicast, but there is no second host and no peer"
        yield found(graph, ("network", "discovery"), message)
