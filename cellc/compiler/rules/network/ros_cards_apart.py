"""The cards for ROS of two hosts share no subnet.

Multicast discovery ends at the first router. Unicast crosses it only where somebody routes, and a mistyped octet looks
the same: each host sees only its own nodes.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  vision_pc: {nics: {cell: {address: 10.21.0.11/24}}}  # expect at cell.address
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  vision_pc: {nics: {cell: {address: 10.20.0.12/24}}}
```

Fix: put the cards into one subnet.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.graph.network import Nic
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield hosts whose cards for ROS are in no subnet of those of the first host that has one."""
    cards: dict[str, list[Nic]] = {}
    for nic in graph.network.nics:
        if "ros" in nic.carries and nic.interface is not None:
            cards.setdefault(nic.host, []).append(nic)
    seen: list[Nic] = []
    for host, own in cards.items():
        if seen and not any(_meet(nic, other) for nic in own for other in seen):
            other = seen[0]
            message = f"`{own[0].full_name}` must share a subnet with `{other.full_name}`, `{other.text}`,"
            message += f" got `{own[0].text}`"
            related = (Related("the other card", graph.cell.locate(*other.path, "address")),)
            yield found(graph, ("hosts", host, "nics", own[0].name, "address"), message, related=related)
        seen += own


def _meet(one: Nic, other: Nic) -> bool:
    assert one.interface is not None
    assert other.interface is not None
    return one.interface.network.overlaps(other.interface.network)
