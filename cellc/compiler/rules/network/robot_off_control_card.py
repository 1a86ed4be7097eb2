"""A robot is connected to a card that does not carry control.

Whatever else that card carries delays the robot's packets, and nothing in the spec forbids it.

Example that is reported:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10/24, carries: [ros]}}}
# expect at devices.arm.connection.nic
```

Example that is accepted:

```yaml
hosts:
  control_pc: {nics: {robot: {address: 192.168.56.10/24, carries: [control]}}}
```

Fix: write `carries: [control]` at the card, or connect the robot to the card that has it.

Source: docs/principles.md#the-control-link
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield arms that want a dedicated link on a card without control."""
    dedicated = {d.name for d in graph.cell.devices if d.network is not None and d.network.dedicated_link}
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if device.device in dedicated and nic is not None and "control" not in nic.carries:
            message = f"`{device.device}` is on `{nic.full_name}`, which does not carry control"
            yield found(graph, (*device.path, "nic"), message)
