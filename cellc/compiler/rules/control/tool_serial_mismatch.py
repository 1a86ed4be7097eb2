"""A tool speaks another serial line than the tool connector of its robot forwards.

The driver of the tool opens its port without a complaint, writes, and reads nothing or garbage: the component fails as
it is activated, with a count of bytes as its only word. Neither end reports that the other has another baud rate.

Example that is reported:

```yaml
devices:
  arm: {tool_connector: {voltage: 24 V, serial: {port: /run/user/1000/arm_tool, baud_rate: 9600}}}
  gripper: {connection: {host: control_pc, port: /run/user/1000/arm_tool, through: arm}}  # expect at through
```

Example that is accepted:

```yaml
devices:
  arm: {tool_connector: {voltage: 24 V, serial: {port: /run/user/1000/arm_tool, baud_rate: 115200}}}
  gripper: {connection: {host: control_pc, port: /run/user/1000/arm_tool, through: arm}}
```

Fix: give the serial line of the tool connector the settings of the tool, on the computer that runs its driver.

Source: https://github.com/PickNikRobotics/ros2_robotiq_gripper/issues/88 (2024): 8 bytes wanted, 0 read
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.device import Connection, Device
from cellc.compiler.cell.robot import ToolSerial
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield tools that speak a serial line which is not forwarded, not to their computer, or set otherwise."""
    for device in graph.cell.devices:
        link, speaks = device.connection, None if device.plug is None else device.plug.serial
        if link is None or link.through is None or link.address is not None:
            continue
        path = (*device.path, "connection", "through")
        robot = graph.cell.device(link.through)
        serial = None if robot.tool_connector is None else robot.tool_connector.serial
        if serial is None and speaks is not None and link.port is None and robot.tool_connector is not None:
            message = f"`{device.name}` must have a serial port: the tool connector of `{robot.name}` forwards none"
            yield found(graph, path, message, f"write `serial` of the tool connector of `{robot.name}`, or a `port`")
        elif serial is not None and link.port == serial.port:
            related = (Related("forwarded here", graph.cell.locate(*robot.path, "tool_connector", "serial")),)
            for message in (*_elsewhere(device, link, robot), *_differences(device, speaks, serial)):
                yield found(graph, path, message, related=related)


def _elsewhere(device: Device, link: Connection, robot: Device) -> Iterator[str]:
    if link.host != robot.host:
        yield f"`{device.name}` must be reached from `{robot.host}`, where its port is forwarded, got `{link.host}`"


def _differences(device: Device, speaks: Mapping[str, str | int] | None, serial: ToolSerial) -> Iterator[str]:
    for key, wanted in (speaks or {}).items():
        if (got := getattr(serial, key)) != wanted:
            yield f"`{key}` of the tool connector must be {wanted} for `{device.name}`, got {got}"
