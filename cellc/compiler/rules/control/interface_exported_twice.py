"""Two devices under one controller manager export an interface of the same name.

Some drivers have the name of an interface in their code, so that no prefix parts two of them. The controller manager
keeps each name once, and takes the second for an error as it loads the hardware. The mock has no driver, and shows
nothing of it.

Example that is reported:

```yaml
devices:
  left: {model: ./named_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
  right:  # expect at devices.right
    {model: ./named_arm, mount: {parent: world, xyz: 0 3 0 m}, revision: A, firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  left: {model: ./named_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: give each of the two devices a controller manager of its own, in a namespace of its own.

Source: https://github.com/ros-controls/ros2_control/blob/4.46.0/hardware_interface/src/resource_manager.cpp#L720
(4.46.0): a command interface whose name is there already is an error
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.BLOCKER, assumes=("shared-prefix",))
def check(graph: CellGraph) -> Findings:
    """Yield each device of a manager that exports what an earlier one exports, one finding a device."""
    for manager in graph.cell.managers:
        first: dict[str, Device] = {}
        for device in map(graph.cell.device, manager.devices):
            twice = [name for name in _exported(device) if first.setdefault(name, device) is not device]
            if twice:
                earlier = first[twice[0]]
                more = f" and {len(twice) - 1} more" if len(twice) > 1 else ""
                message = f"`{device.name}` and `{earlier.name}` both export `{twice[0]}`{more} to `{manager.node}`"
                related = (Related(f"`{earlier.name}` is here", earlier.span),)
                yield found(graph, device.path, message, related=related)


def _exported(device: Device) -> Iterator[str]:
    """Yield the interfaces of sensors and gpios by full name; joints are named once in a cell."""
    hardware = device.hardware
    for group in () if hardware is None else (*hardware.sensors, *hardware.gpios):
        yield from (f"{group.name}/{name}" for name in (*group.command_interfaces, *group.state_interfaces))
