"""Two cards or devices have the same address.

Packets reach whichever answered last. The link looks unstable, and commands may go to the other device.

Example that is reported:

```yaml
devices: {arm: {connection: {address: 192.168.56.10}}}  # expect at address
```

Example that is accepted:

```yaml
devices: {arm: {connection: {address: 192.168.56.101}}}
```

Fix: give each card and each device an address of its own.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from ipaddress import IPv4Address

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second and every later bearer of an address."""
    bearers = [(nic.interface.ip, nic.full_name, nic.path) for nic in graph.network.nics if nic.interface is not None]
    bearers += [(d.address, d.device, d.path) for d in graph.network.devices if d.address is not None]
    first: dict[IPv4Address, tuple[str, YamlPath]] = {}
    for address, name, path in bearers:
        earlier_name, earlier_path = first.setdefault(address, (name, path))
        if earlier_path != path:
            message = f"`{name}` and `{earlier_name}` both have address {address}"
            related = (Related("first used here", graph.cell.locate(*earlier_path, "address")),)
            yield found(graph, (*path, "address"), message, related=related)
