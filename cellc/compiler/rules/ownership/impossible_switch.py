"""A declared switch can never be carried out.

A strict switch is refused where a controller that it stops is not active, or one that it starts already is. No state
that the cell can reach satisfies this one.

Example that is reported:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  parameters: {interface_name: position}}
  switches:
    to_trajectory: {activate: [arm_trajectory], deactivate: [arm_forward]}  # expect at to_trajectory
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  parameters: {interface_name: position}}
  switches:
    to_forward: {activate: [arm_forward], deactivate: [arm_trajectory]}
    to_trajectory: {activate: [arm_trajectory], deactivate: [arm_forward]}
```

Fix: declare the switch that leads to the state in which this one starts, or correct the lists.

Source: https://docs.ros.org/en/jazzy/p/controller_manager_msgs/srv/SwitchController.html (Jazzy): strictness STRICT
"""

from __future__ import annotations

from cellc.compiler.graph.claims import can_switch
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("double-claim", "two-interfaces-of-one-joint"))
def check(graph: CellGraph) -> Findings:
    """Yield switches that no reachable state allows."""
    for manager in graph.cell.managers:
        states = [state for state in graph.claims.states if state.manager == manager.name]
        active = [frozenset(controller.name for controller in state.active) for state in states]
        for switch in manager.switches:
            if not any(can_switch(names, switch) for names in active):
                message = f"switch `{switch.name}` cannot be carried out in any state that the cell reaches"
                yield found(graph, switch.path, message)
