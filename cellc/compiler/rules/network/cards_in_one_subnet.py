"""Two cards of a host are in one subnet.

The kernel sends by one of them whatever the socket was bound to, so images leave on the control card after all.

Example that is reported:

```yaml
hosts:
  control_pc: {nics: {bulk: {address: 192.168.56.11/24}}}  # expect at address
```

Example that is accepted:

```yaml
hosts:
  control_pc: {nics: {bulk: {address: 10.10.0.10/24}}}
```

Fix: give each card a subnet of its own.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from itertools import combinations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second card of a host whose subnet overlaps."""
    for first, second in combinations(graph.network.nics, 2):
        if first.host != second.host or first.interface is None or second.interface is None:
            continue
        same = first.interface.ip == second.interface.ip  # a duplicate address, which is reported as such
        if first.interface.network.overlaps(second.interface.network) and not same:
            message = f"`{second.full_name}` and `{first.full_name}` are both in {first.interface.network}"
            related = (Related("the other card is here", graph.cell.locate(*first.path, "address")),)
            yield found(graph, (*second.path, "address"), message, related=related)
