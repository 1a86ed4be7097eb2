"""A device has an address of the public internet.

A robot controller has no business there: either the address is mistyped, or the device can be reached by anybody.

Example that is reported:

```yaml
devices: {arm: {connection: {nic: null, address: 8.8.8.8}}}  # expect at address
hosts: {control_pc: {nics: {robot: {address: 8.8.8.10/24}}}}
```

Example that is accepted:

```yaml
devices: {arm: {connection: {nic: null, address: 192.168.56.101}}}
```

Fix: use an address of a private network: 10/8, 172.16/12 or 192.168/16.

Source:

- https://www.rfc-editor.org/rfc/rfc1918 (1996-02): private addresses
- docs/principles.md#the-control-link
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices with a global address."""
    for device in graph.network.devices:
        if device.address is not None and device.address.is_global:
            message = f"{device.address} of `{device.device}` is a public address"
            yield found(graph, (*device.path, "address"), message)
