"""A device is not in the subnet of the card that it is connected to.

Packets to it leave by another card or by the default route, if at all.

Example that is reported:

```yaml
devices: {arm: {connection: {address: 192.168.57.101}}}  # expect at address
```

Example that is accepted:

```yaml
devices: {arm: {connection: {address: 192.168.56.101}}}
```

Fix: use an address of the card's subnet, or name the card that it is plugged into.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices with an address outside the subnet of their card."""
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if nic is None or nic.interface is None or device.address is None:
            continue
        if device.address not in nic.interface.network:
            message = f"{device.address} of `{device.device}` is not in {nic.interface.network} of `{nic.full_name}`"
            related = (Related("the card is here", graph.cell.locate(*nic.path, "address")),)
            yield found(graph, (*device.path, "address"), message, related=related)
