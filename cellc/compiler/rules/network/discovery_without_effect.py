"""Peers or discovery servers are listed, and nothing asks them.

Each kind of discovery reads its own list: `unicast` the peers, `server` the servers. A list that another kind does not
read looks like a connection to the other computer, and is not one.

Example that is reported:

```yaml
network:
  discovery: multicast
  peers: [10.10.0.11]  # expect at peers
```

Example that is accepted:

```yaml
network:
  discovery: unicast
  peers: [10.10.0.11]
```

Fix: choose the `discovery` that reads the list, or delete the list.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html
(Jazzy): which settings find whom
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_READS = {"peers": "unicast", "servers": "server"}


@rule(Severity.WARNING, assumes=("discovery-unknown-to-rmw",))
def check(graph: CellGraph) -> Findings:
    """Yield lists that the chosen discovery does not read."""
    network = graph.cell.network
    for key, kind in _READS.items():
        if getattr(network, key) and network.discovery != kind:
            message = f"`{key}` are asked by `discovery: {kind}` alone, got `{network.discovery}`"
            yield found(graph, ("network", key), message)
