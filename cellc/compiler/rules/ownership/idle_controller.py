"""A controller is never active.

It is loaded, configured and listed, and no declared switch activates it. Somebody will force it one day.

Example that is reported:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,  # expect at arm_forward
                  parameters: {interface_name: position}}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  parameters: {interface_name: position}}
  switches:
    to_forward: {activate: [arm_forward], deactivate: [arm_trajectory]}
```

Fix: declare the switch that activates it, or delete it.

Source: docs/principles.md#claims-and-switches
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=("double-claim", "double-claim-after-switch", "impossible-switch"))
def check(graph: CellGraph) -> Findings:
    """Yield controllers that are active in no reachable state."""
    for manager in graph.cell.managers:
        active = graph.claims.ever_active(manager.name)
        for controller in manager.controllers:
            if controller.name not in active:
                message = f"controller `{controller.name}` starts inactive and no switch activates it"
                yield found(graph, controller.path, message)
