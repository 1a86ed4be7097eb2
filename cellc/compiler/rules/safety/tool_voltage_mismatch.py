"""A tool takes another voltage than the tool connector of its robot gives.

24 V on a tool for 12 V destroys it at the moment in which the program of the robot first starts, with smoke or without
a sign; 12 V, or none, leaves a gripper that answers nothing, or that lets go under load. Nothing in ROS knows of it.

Example that is reported:

```yaml
devices:
  arm: {tool_connector: {voltage: 12 V}}
  gripper: {connection: {host: control_pc, port: /dev/ttyUSB0, through: arm}}  # expect at through
```

Example that is accepted:

```yaml
devices:
  arm: {tool_connector: {voltage: 24 V}}
  gripper: {connection: {host: control_pc, port: /dev/ttyUSB0, through: arm}}
```

Fix: give the connector the voltage on the nameplate of the tool, or power the tool from elsewhere.

Source: https://github.com/UniversalRobots/Universal_Robots_ROS2_Driver/releases/tag/6.0.0 (6.0.0): tool communication
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield tools on the connector of another robot, of one without settings, or of one with another voltage."""
    for device in graph.cell.devices:
        link = device.connection
        if link is None or link.through is None:
            continue
        path = (*device.path, "connection", "through")
        robot = graph.cell.device(link.through)
        place = (*robot.path, "tool_connector")
        if device.name not in _hanging(graph, robot):
            message = f"`{device.name}` must hang on `{robot.name}`, from whose tool connector it has its power"
            yield found(graph, path, message, "name the robot that carries it")
        if robot.tool_connector is None:
            message = f"`{device.name}` has its power from `{robot.name}`, whose tool connector gives nothing stated"
            yield found(graph, path, message, f"write `tool_connector` of `{robot.name}` with the voltage of its tool")
        elif device.plug is not None and device.plug.voltage_v != robot.tool_connector.voltage_v:
            given = f"{robot.tool_connector.voltage_v:g} V of `{robot.name}`"
            message = f"the tool connector must give `{device.name}` {device.plug.voltage_v:g} V, got {given}"
            related = (Related("stated here", graph.cell.locate(*place, "voltage")),)
            yield found(graph, path, message, related=related)


def _hanging(graph: CellGraph, robot: Device) -> set[str]:
    """Return what a robot carries, and what hangs on that."""
    carried: set[str] = set()
    left = [*robot.carries]
    while left:
        name = left.pop()
        if name not in carried:
            carried.add(name)
            left += graph.cell.device(name).carries
    return carried
