"""A declared switch leads to two controllers that claim one command interface.

It shows the first time that the switch is needed, and what happens then depends on the version. ros2_control 4.39.1
(Jazzy), 5.9.0 (Kilted) and later refuse the switch as a whole before anything changes: the controllers that were to
stop go on. Older ones and Humble carry it out but for the controller whose interface is taken: what was to stop has
stopped, and its joints may have no controller. All of them answer that the switch failed.

Example that is reported:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  parameters: {interface_name: position}}
  switches:
    to_forward: {activate: [arm_forward]}  # expect at to_forward
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

Fix: deactivate in the same switch what holds the interface.

Source:

- https://docs.ros.org/en/jazzy/p/controller_manager_msgs/srv/SwitchController.html (Jazzy)
- https://github.com/ros-controls/ros2_control/pull/2760 (4.39.1)
- https://github.com/ros-controls/ros2_control/blob/humble/controller_manager/src/controller_manager.cpp (2.54.0)
- docs/principles.md#claims-and-switches
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the switch that leads into a state with two claimants, with the way to that state."""
    for conflict in graph.claims.conflicts():
        if not conflict.state.switches:
            continue
        first, second = conflict.first, conflict.second
        way = " → ".join(f"`{name}`" for name in ("start", *conflict.state.switches))
        message = f"after {way} both `{first.name}` and `{second.name}` claim `{conflict.interface}`"
        manager = next(m for m in graph.cell.managers if m.name == conflict.state.manager)
        path = (*manager.path, "switches", conflict.state.switches[-1])
        related = (Related("first claimed here", first.span), Related("claimed again here", second.span))
        yield found(graph, path, message, f"deactivate `{first.name}` in the same switch", related)
