"""Two devices are reached over one port, serial or CAN.

The second driver finds the port taken, or both write into it and each reads the answers of the other. A gripper then
opens when the other one was commanded to.

Example that is reported:

```yaml
devices:
  camera: {connection: {host: control_pc, port: /dev/ttyUSB0}}
  gripper: {connection: {host: control_pc, port: /dev/ttyUSB0}}  # expect at port
```

Example that is accepted:

```yaml
devices:
  camera: {connection: {host: control_pc, port: /dev/ttyUSB1}}
  gripper: {connection: {host: control_pc, port: /dev/ttyUSB0}}
```

Fix: write the port of each device, at best by a name that does not change: `/dev/serial/by-id/…`, or what udev calls a
CAN bus.

Source: https://man7.org/linux/man-pages/man2/TIOCEXCL.2const.html
(man-pages 6.9): only a port that was put into exclusive mode refuses a second reader
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second device of a port on one host, and the second tool connector that becomes one."""
    first: dict[tuple[str, str], Device] = {}
    forwarded: dict[tuple[str, str], Device] = {}
    for device in graph.cell.devices:
        serial = None if device.tool_connector is None else device.tool_connector.serial
        robot = device if serial is None else forwarded.setdefault((device.host, serial.port), device)
        if robot is not device:
            path = (*device.path, "tool_connector", "serial", "port")
            message = f"`{device.name}` must forward its tool to a port of its own, got that of `{robot.name}`"
            related = (Related("first used here", graph.cell.locate(*robot.path, *path[2:])),)
            yield found(graph, path, message, related=related)
        link = device.connection
        if link is None or link.port is None or link.address is not None:
            continue
        owner = first.setdefault((link.host, link.port), device)
        if owner is not device:
            path = (*device.path, "connection", "port")
            message = f"`{device.name}` must have a port of its own on `{link.host}`, got that of `{owner.name}`"
            related = (Related("first used here", graph.cell.locate(*owner.path, "connection", "port")),)
            yield found(graph, path, message, related=related)
