"""A port is stated for a driver that listens on none, or on ports that nothing moves.

`first_port` says where the ports begin to which a device connects back. A driver that has none, or whose `device.yaml`
has them as plain numbers, goes on as before: who opened the port in a firewall, or typed it at the device, waits.

Example that is reported:

```yaml
devices:
  gripper:
    connection: {host: control_pc, port: /dev/ttyUSB0, first_port: 50101}  # expect at first_port
```

Example that is accepted:

```yaml
devices:
  gripper:
    connection: {host: control_pc, port: /dev/ttyUSB0}
```

Fix: remove it, or write the port in `device.yaml` as `{port_N}`.

Source: docs/principles.md#the-control-link
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield stated ports that are not those on which a driver listens."""
    for device in graph.cell.devices:
        path = (*device.path, "connection", "first_port")
        stated = graph.cell.text(*path)
        listens = () if device.network is None else device.network.listens
        if stated and stated != str(min(listens, default=0)):
            where = f"from {min(listens)} on, whatever is stated" if listens else "on no port"
            yield found(graph, path, f"the driver of `{device.name}` listens {where}: got {stated}")
