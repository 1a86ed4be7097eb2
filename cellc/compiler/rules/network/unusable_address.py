"""An address is the network or broadcast address of its subnet.

The first and the last address of a subnet belong to no host.

Example that is reported:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.0/24}}}  # expect at address
```

Example that is accepted:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10/24}}}
```

Fix: use an address between the first and the last of the subnet.

Source:

- https://www.rfc-editor.org/rfc/rfc919 (1984-10): broadcast addresses
- https://www.rfc-editor.org/rfc/rfc3021 (2000-12): prefixes of 31 bits
"""

from __future__ import annotations

from ipaddress import IPv4Address

from cellc.compiler.graph.network import Nic
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield cards and devices with the network or broadcast address of their subnet."""
    for nic in graph.network.nics:
        if nic.interface is not None and _reserved(nic, nic.interface.ip):
            message = f"{nic.interface.ip} of `{nic.full_name}` is not a host address in {nic.interface.network}"
            yield found(graph, (*nic.path, "address"), message)
    for device in graph.network.devices:
        card = graph.network.nic_of(device)
        if card is not None and device.address is not None and _reserved(card, device.address):
            message = f"{device.address} of `{device.device}` is not a host address"
            yield found(graph, (*device.path, "address"), message)


def _reserved(nic: Nic, address: IPv4Address) -> bool:
    # RFC 3021: a /31 has two hosts and neither of the two addresses; a /32 has one.
    if nic.interface is None or nic.interface.network.prefixlen >= 31:
        return False
    return address in (nic.interface.network.network_address, nic.interface.network.broadcast_address)
