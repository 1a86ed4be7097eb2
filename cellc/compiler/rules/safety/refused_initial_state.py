"""A device starts in a state in which it moves by itself, or has wrong commands.

The controller manager brings hardware up before anybody looked whether the area is empty. What moves as it is
activated, or may move, is activated by a person in gate G5. Where the vendor asks for one
call from `unconfigured` to `active`, a stay in `inactive` leaves a driver with commands that were never set.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./bare_arm_with_tool, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             initial_state: active}  # expect at initial_state
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./bare_arm_with_tool, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             initial_state: unconfigured}
```

Fix: leave `initial_state` out, or state one in which the device neither moves nor is left half way.

Source: https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html
(Jazzy): hardware_components_initial_state
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import HardwareComponent
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import Moment


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield states of components that move at the start, that the vendor excludes, or that no step activates."""
    for device in graph.cell.devices:
        if device.initial_state is None:
            continue
        path = (*device.path, "initial_state")
        if device.hardware is None:
            yield found(graph, path, f"no controller manager brings up `{device.name}`: it has no hardware component")
        elif refused := _refused(device, device.hardware):
            yield found(graph, path, refused)


def _refused(device: Device, hardware: HardwareComponent) -> str:
    """Return why a component must not start as stated; empty where it may."""
    said = f"`{device.name}` must not start `{device.initial_state}`:"
    if device.initial_state == "active":
        if not hardware.is_activation_known:
            return f"{said} the effect of its activation is not stated"
        if hardware.moves_as_it_is_activated:
            return f"{said} its activation {hardware.effects[Moment.ACTIVATE].does.split('; ')[0]}"
    if hardware.at_once and device.initial_state != hardware.initial_state:
        return f"{said} it must become active in one call from `{hardware.initial_state}`"
    return ""
