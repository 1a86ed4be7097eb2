"""A robot has a voltage or a serial setting that its tool connector does not support.

The driver reads these settings as it connects. One that the robot does not know ends the configuration of the hardware
with an exception that names no tool, or is cut to the next one that it has.

Example that is reported:

```yaml
devices:
  arm: {tool_connector: {voltage: 48 V}}  # expect at voltage
```

Example that is accepted:

```yaml
devices:
  arm: {tool_connector: {voltage: 24 V, serial: {port: /run/user/1000/arm_tool, baud_rate: 115200}}}
```

Fix: write a voltage and settings that the robot has; its `device.yaml` lists them under `robot.tool_connector`.

Source: https://github.com/UniversalRobots/Universal_Robots_Client_Library/releases/tag/2.14.0 (2.14.0): ToolCommSetup
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.compiler.cell.robot import ToolFacts, ToolSerial
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield connectors of robots that have none, and values that they do not give."""
    for device in graph.cell.devices:
        stated, has = device.tool_connector, device.robot.tool_facts
        if stated is None:
            continue
        path = (*device.path, "tool_connector")
        if has is None:
            yield found(graph, path, f"`{device.name}` has no tool connector that its driver sets")
            continue
        if stated.voltage_v not in has.voltages_v:
            given = _listed(f"{value:g} V" for value in has.voltages_v)
            message = f"the tool connector of `{device.name}` must give {given}, got {stated.voltage_v:g} V"
            yield found(graph, (*path, "voltage"), message)
        if stated.serial is not None and not has.has_serial:
            yield found(graph, (*path, "serial"), f"the tool connector of `{device.name}` has no serial line")
        elif stated.serial is not None:
            for key, wanted, got in _refused(stated.serial, has):
                message = f"`{key}` of the tool connector of `{device.name}` must be {wanted}, got {got}"
                yield found(graph, (*path, "serial", key), message)


def _refused(stated: ToolSerial, has: ToolFacts) -> Iterator[tuple[str, str, str]]:
    """Yield each setting that the robot does not have, what it has, and what is written."""
    for key, allowed in has.settings.items():
        if getattr(stated, key) not in allowed:
            yield key, _listed(map(str, allowed)), str(getattr(stated, key))
    for key, (least, most) in has.spans.items():
        value = getattr(stated, key)
        if value is not None and not least <= value <= most:
            yield key, f"from {least:g} to {most:g}", f"{value:g}"


def _listed(names: Iterable[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last
