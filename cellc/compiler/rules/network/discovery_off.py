"""Discovery is off, so that no two processes find each other.

With discovery off, nodes in two processes never meet, on one host either.

Example that is reported:

```yaml
network: {discovery: "off"}  # expect at discovery
```

Example that is accepted:

```yaml
network: {discovery: localhost}
```

Fix: use `localhost` for a cell on one host.

Source: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html
(Jazzy): OFF is never discovered
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield discovery that is off in a cell of one host or none."""
    if graph.cell.network.discovery == "off" and len(graph.cell.hosts) < 2:
        message = "discovery is off, so no two processes of the cell find each other"
        yield found(graph, ("network", "discovery"), message)
