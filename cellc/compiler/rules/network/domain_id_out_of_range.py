"""The domain id is out of range.

DDS derives its ports from the domain. Above 232 they do not exist, and below 0 there is no domain.

Example that is reported:

```yaml
network: {domain_id: 300}  # expect at domain_id
```

Example that is accepted:

```yaml
network: {domain_id: 42}
```

Fix: use 0 to 101.

Source: https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html (Jazzy)
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LARGEST = 232


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a domain outside 0 to 232."""
    domain = graph.cell.network.domain_id
    if not 0 <= domain <= _LARGEST:
        message = f"`domain_id` must be between 0 and {_LARGEST}, got {domain}"
        yield found(graph, ("network", "domain_id"), message)
