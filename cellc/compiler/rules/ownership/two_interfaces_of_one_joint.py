"""Two active controllers command one joint through different interfaces.

The claims do not collide, so that ros2_control grants both. The hardware then gets a position and a velocity for one
joint, and which of them it obeys is decided by its driver, or by the order of the updates.

Example that is reported:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: true,  # expect at arm_forward
                  command_interfaces: [velocity], parameters: {interface_name: velocity}}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  command_interfaces: [velocity], parameters: {interface_name: velocity}}
  switches:
    to_forward: {activate: [arm_forward], deactivate: [arm_trajectory]}
    back: {activate: [arm_trajectory], deactivate: [arm_forward]}
```

Fix: let one of them start with `active: false`, and declare the switch between them.

Source: docs/principles.md#claims-and-switches
"""

from __future__ import annotations

from cellc.compiler.cell.control import Controller
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("double-claim", "shared-prefix"))
def check(graph: CellGraph) -> Findings:
    """Yield each second controller of a joint in a state that the cell reaches, once for a pair."""
    joints = {joint.name for device in graph.cell.devices for joint in device.joints}
    seen: set[tuple[str, str, str]] = set()
    for state in graph.claims.states:
        owners: dict[str, tuple[str, Controller]] = {}
        for controller in state.active:
            for interface in controller.command_interfaces:
                joint, _, kind = interface.rpartition("/")
                other_kind, owner = owners.setdefault(joint, (kind, controller))
                pair = (state.manager, owner.name, controller.name)
                if joint not in joints or owner is controller or pair in seen or other_kind == kind:
                    continue
                seen.add(pair)
                when = f" after `{'`, `'.join(state.switches)}`" if state.switches else " from the start"
                message = f"`{controller.name}` commands the {kind} of `{joint}`, of which `{owner.name}` commands the"
                related = (Related("commanded here too", owner.span),)
                yield found(graph, controller.path, f"{message} {other_kind},{when}", related=related)
