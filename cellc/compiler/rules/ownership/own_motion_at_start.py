"""A controller that moves its device past the joints' interfaces is active from the start.

Force control, hand guiding and trajectories that the robot interpolates by itself claim interfaces of their own, so
that no claim of a joint collides with them. Active from the start, each waits for one call that sets the arm in motion
while another controller believes that it holds it, or takes the driver's only way of commanding.

Example that is reported:

```yaml
control:
  controllers:
    arm_guiding: {type: hand_guiding, device: arm, client: task}  # expect at arm_guiding
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_guiding: {type: hand_guiding, device: arm, client: task, active: false}
  switches:
    to_guiding: {activate: [arm_guiding], deactivate: [arm_trajectory]}
    back: {activate: [arm_trajectory], deactivate: [arm_guiding]}
```

Fix: let it start with `active: false`, and declare the switch to it.

Source: https://github.com/UniversalRobots/Universal_Robots_ROS2_Driver/tree/3.8.0/ur_controllers (3.8.0)
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import Behaviour


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers of a device's own motion that no step switches to."""
    for controller in graph.cell.controllers:
        if controller.behaviour is Behaviour.OWN_MOTION and controller.active:
            message = f"`{controller.name}` moves `{controller.device}` past its joints, and is active from the start"
            yield found(graph, controller.path, message)
