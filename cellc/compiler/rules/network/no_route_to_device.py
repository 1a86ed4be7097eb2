"""No card of the host reaches a device.

The driver's host has no card in the subnet of the device.

Example that is reported:

```yaml
devices: {arm: {connection: {nic: null, address: 172.16.0.2}}}  # expect at address
```

Example that is accepted:

```yaml
devices: {arm: {connection: {nic: null, address: 192.168.56.101}}}
```

Fix: add a card in the subnet of the device, or correct one of the addresses.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices without a named card whose address is in no subnet of their host."""
    for device in graph.network.devices:
        if device.nic is not None or device.address is None:
            continue
        cards = [nic for nic in graph.network.nics if nic.host == device.host and nic.interface is not None]
        if not any(nic.interface is not None and device.address in nic.interface.network for nic in cards):
            message = f"no card of `{device.host}` is in the subnet of {device.address} of `{device.device}`"
            yield found(graph, (*device.path, "address"), message)
