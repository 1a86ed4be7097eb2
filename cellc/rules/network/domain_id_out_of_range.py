"""The domain id has no ports.

DDS derives its ports from the domain. Above 232 they do not exist, and below 0 there is no domain.

Example that is reported:

```yaml
network: {domain_id: 300}
```

Example that is accepted:

```yaml
network: {domain_id: 42}
```

Fix: use 0 to 101.

Source: RTPS port mapping, 7400 + 250 d; ROS_DOMAIN_ID 0 to 232.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found

_LARGEST = 232


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield a domain outside 0 to 232."""
    domain = graph.cell.spec.network.domain_id
    if not 0 <= domain <= _LARGEST:
        message = f"domain {domain} is outside 0 to {_LARGEST}"
        yield found(graph, ("network", "domain_id"), message, "use 0 to 101")


RULE = define("domain-id-out-of-range", Severity.ERROR, check, __doc__)
