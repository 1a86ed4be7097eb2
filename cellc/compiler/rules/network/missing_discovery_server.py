"""The cell uses a discovery server, but names none.

A participant that uses a server announces itself only there. Without one, no two processes of the cell meet, on one
host either.

Example that is reported:

```yaml
network: {discovery: server}  # expect at discovery
```

Example that is accepted:

```yaml
network: {discovery: server, servers: [{host: control_pc}]}
```

Fix: name the host that a server runs on under `servers:`, or use another discovery.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Discovery-Server/Discovery-Server.html
(Jazzy): clients connect to the servers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield discovery by a server in a cell that has none."""
    network = graph.cell.network
    if network.discovery == "server" and not network.servers:
        yield found(graph, ("network", "discovery"), "`servers` must name a host, as the nodes ask a server, got none")
