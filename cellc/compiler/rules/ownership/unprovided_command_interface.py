"""A controller claims a command interface that the hardware does not have.

The controller manager refuses to activate it. In the list of controllers it stays inactive, and goals are rejected.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [effort]}  # expect at command_interfaces
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {command_interfaces: [position]}
```

Fix: claim an interface that the joint has.

Source: https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html
(Jazzy): a controller needs all its interfaces to be activated
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers with claims that no joint, sensor or gpio of the cell provides, one finding a controller."""
    provided = {
        f"{joint.name}/{name}"
        for device in graph.cell.devices
        for joint in device.joints
        for name in joint.command_interfaces
    }
    for device in graph.cell.devices:
        for gpio in device.hardware.gpios if device.hardware is not None else ():
            provided |= {f"{gpio.name}/{name}" for name in gpio.command_interfaces}
    for controller in graph.cell.controllers:
        missing = [claim for claim in controller.all_claims if claim not in provided]
        if missing:
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            message = f"`{controller.name}` claims `{missing[0]}`{more}, which no hardware provides"
            joint = missing[0].rpartition("/")[0]
            own = [name for name in provided if name.startswith(f"{joint}/")]
            path = (*controller.path, "command_interfaces")
            yield found(graph, path, message, did_you_mean(missing[0], own, f"command interfaces of `{joint}`"))
