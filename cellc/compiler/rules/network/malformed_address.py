"""An address is not an IPv4 address.

A name, a missing prefix length or a typing error: the card gets no address, or the driver waits for a device that
does not exist.

Example that is reported:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10}}}  # expect at address
```

Example that is accepted:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10/24}}}
```

Fix: write four numbers from 0 to 255, for a card with the prefix length, such as `192.168.56.10/24`.

Source:

- https://www.rfc-editor.org/rfc/rfc4632 (2006-08): prefix lengths
- docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield cards and devices whose address cannot be read."""
    for nic in graph.network.nics:
        if nic.interface is None:
            message = f"expected an IPv4 address with a prefix length for `{nic.full_name}`, got `{nic.text}`"
            yield found(graph, (*nic.path, "address"), message, "write it such as `192.168.56.10/24`")
    for device in graph.network.devices:
        if device.text is not None and device.address is None:
            message = f"expected an IPv4 address for `{device.device}`, got `{device.text}`"
            yield found(graph, (*device.path, "address"), message, "write it such as `192.168.56.101`")
