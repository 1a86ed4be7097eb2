"""A camera is connected to the card of the robot.

Its stream fills the queue of the card, whatever `carries` says.

Example that is reported:

```yaml
devices: {camera: {connection: {nic: robot}}}  # expect at nic
```

Example that is accepted:

```yaml
devices: {camera: {connection: {nic: bulk}}}
```

Fix: connect it to another card.

Source: docs/principles.md#the-control-link
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield cameras on a card that carries control."""
    cameras = {device.name for device in graph.cell.devices if device.kind == "camera"}
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if nic is not None and "control" in nic.carries and device.device in cameras:
            message = f"camera `{device.device}` is on `{nic.full_name}`, which carries control"
            yield found(graph, (*device.path, "nic"), message)
