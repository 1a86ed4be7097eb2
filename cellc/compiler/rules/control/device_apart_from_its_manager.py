"""A device is connected to another computer than the one that drives it.

Its hardware component runs in the controller manager, and opens the port or the address on the computer of that. That
one lacks the port, or a card that reaches the device, and the manager does not start.

Example that is reported:

```yaml
# a cell of two computers
devices: {gripper: {connection: {host: vision_pc, port: /dev/ttyUSB0}}}  # expect at host
```

Example that is accepted:

```yaml
# a cell of two computers
devices: {gripper: {connection: {host: control_pc, port: /dev/ttyUSB0}}}
```

Fix: connect the device to the host of its controller manager, or run a manager with a namespace of its own there.

Source: https://control.ros.org/jazzy/doc/getting_started/getting_started.html
(Jazzy): hardware components are plugins of the controller manager
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices of a manager that are connected to another host than its own."""
    devices = {device.name: device for device in graph.cell.devices}
    for manager in graph.cell.managers:
        for name in manager.devices:
            device = devices[name]
            link = device.connection
            if link is None or device.hardware is None or link.host == manager.host or not manager.host:
                continue
            message = f"`{name}` must be connected to `{manager.host}`, where its controller manager runs, got"
            related = (Related("the manager", graph.cell.locate(*manager.path)),)
            yield found(graph, (*device.path, "connection", "host"), f"{message} `{link.host}`", related=related)
