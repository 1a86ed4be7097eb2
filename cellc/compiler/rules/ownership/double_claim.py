"""Two controllers that are active at start claim one command interface.

ros2_control grants a command interface to one controller. The second is refused when it is activated, so which of the
two drives the joint depends on the order of the spawners.

Example that is reported:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: true,  # expect at arm_forward
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

Fix: let one of them start with `active: false`, and declare the switch between them.

Source:

- https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html
  (Jazzy): a command interface is claimed by one controller
- docs/principles.md#claims-and-switches
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("shared-prefix",))
def check(graph: CellGraph) -> Findings:
    """Yield the second claimant of an interface in the first state of a manager."""
    for conflict in graph.claims.conflicts():
        if not conflict.state.switches:
            first, second = conflict.first, conflict.second
            message = f"`{second.name}` claims `{conflict.interface}`, which `{first.name}` claims too, from the start"
            related = (Related("first claimed here", first.span),)
            yield found(graph, second.path, message, related=related)
