"""An observation is too old at the end of its chain, although each step keeps its own limit.

A detector passes the stamp of the image on. Its pose is as old as the image was, plus its own period: the reader's
limit holds for the sum, and a limit that only fits the last step rejects fresh poses.

Example that is reported:

```yaml
interfaces:
  /object_pose: {max_age: 120 ms}  # expect at max_age
```

Example that is accepted:

```yaml
interfaces:
  /object_pose: {max_age: 150 ms}
```

Fix: raise the limit above the sum of the shares, or raise a rate of the chain.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

import math

from cellc.compiler.graph.data_flow import age_chains
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("max-age-too-short",))
def check(graph: CellGraph) -> Findings:
    """Yield topics whose age limit is below the sum of the shares of their chain."""
    chains = age_chains(graph.cell)
    for interface in graph.cell.interfaces:
        shares = chains.get(interface.name, ())
        needed = sum(share.total_s for share in shares)
        if interface.max_age_s is None or len(shares) < 2 or interface.max_age_s >= needed:
            continue
        way = " + ".join(str(share) for share in shares)
        age = interface.max_age_s * 1e3
        message = f"`max_age` of `{interface.name}` must be at least {needed * 1e3:.4g} ms ({way}), got {age:g} ms"
        related = tuple(
            Related("part of the chain", graph.cell.locate("interfaces", share.topic)) for share in shares[:-1]
        )
        advice = f"allow at least {math.ceil(needed * 1e3)} ms, or raise a rate of the chain"
        yield found(graph, (*interface.path, "max_age"), message, advice, related)
