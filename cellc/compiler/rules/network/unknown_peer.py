"""No host of the cell has the address of a peer.

With unicast discovery a participant announces itself to its peers alone. An unused address costs nothing that
anybody sees: the computer that was meant is simply never found.

Example that is reported:

```yaml
# a cell of two computers
network: {discovery: unicast, peers: [10.20.0.10, 10.20.1.11]}  # expect at 1
```

Example that is accepted:

```yaml
# a cell of two computers
network: {discovery: unicast, peers: [10.20.0.10, 10.20.0.11]}
```

Fix: write the address of a card, or add the host that has this one.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.graph.network import read_address
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield peers that are IPv4 addresses and no card's; a cell of one host has only peers that it does not know."""
    if len(graph.cell.hosts) < 2:
        return
    cards = [nic.interface.ip for nic in graph.network.nics if nic.interface is not None]
    known = [str(address) for address in cards]
    for number, peer in enumerate(graph.cell.network.peers):
        address = read_address(peer)
        if address is None or address.is_loopback or address in cards:
            continue
        near = any(nic.interface is not None and address in nic.interface.network for nic in graph.network.nics)
        where = "no host has this address" if near else "no host has this address and no card is in its subnet"
        message = f"peer `{peer}` must be the address of a card, but {where}"
        yield found(graph, ("network", "peers", number), message, did_you_mean(peer, known, "addresses of cards"))
