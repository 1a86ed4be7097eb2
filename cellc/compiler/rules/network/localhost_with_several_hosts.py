"""Discovery is limited to one host, but the cell has several.

Nodes on two hosts never find each other, although each sees its own half.

Example that is reported:

```yaml
# a cell of two computers
network: {discovery: localhost}  # expect at discovery
```

Example that is accepted:

```yaml
# a cell of two computers
network: {discovery: multicast}
```

Fix: use `multicast`, or `unicast` with peers.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html
(Jazzy): LOCALHOST stays on one machine
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield discovery that is bound to the host in a cell of several hosts."""
    discovery, hosts = graph.cell.network.discovery, graph.cell.hosts
    if discovery in ("localhost", "off") and len(hosts) > 1:
        names = " and ".join(f"`{name}`" for name in hosts)
        message = f"discovery is `{discovery}`, but the cell runs on {names}"
        yield found(graph, ("network", "discovery"), message)
