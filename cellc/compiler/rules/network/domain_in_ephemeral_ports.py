"""The ports of the domain are ephemeral ports of Linux.

A browser or an update may take a port of the domain first, and one node then does not start, once a month.

Example that is reported:

```yaml
network: {domain_id: 150}  # expect at domain_id
```

Example that is accepted:

```yaml
network: {domain_id: 42}
```

Fix: use 0 to 101.

Source: https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html
(Jazzy): the ports of Linux that begin at 32768 are those of domains from 102 on
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_FIRST, _LAST = 102, 214


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield a domain whose ports are ephemeral ones."""
    domain = graph.cell.network.domain_id
    if _FIRST <= domain <= _LAST:
        message = f"the ports of domain {domain} are ephemeral ports of Linux"
        yield found(graph, ("network", "domain_id"), message)
