"""A scaled controller drives a device that does not scale.

Speed scaling is one vendor's contract. On another arm the factor does not exist, and the controller refuses to start
or takes a constant for the truth.

Example that is reported:

```yaml
control:
  controllers:
    gripper_action: null
    gripper_trajectory: {type: joint_trajectory, device: gripper, client: task,  # expect at gripper_trajectory
                         goal_time: 1 s, path_tolerance: 10 mm,
                         goal_tolerance: 1 mm,
                         parameters: {speed_scaling.state_interface: arm_speed_scaling/speed_scaling_factor}}
```

Example that is accepted:

```yaml
control:
  controllers:
    gripper_action: null
    gripper_trajectory: {type: joint_trajectory, device: gripper, client: task, goal_time: 1 s, path_tolerance: 10 mm,
                         goal_tolerance: 1 mm}
```

Fix: use `type: joint_trajectory` without a scaling interface.

Source: docs/principles.md#speed-scaling
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import Behaviour


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield controllers that read a scaling factor though their device has none."""
    scaling = {device.name for device in graph.cell.devices if device.speed_scaling is not None}
    for controller in graph.cell.controllers:
        reads = controller.behaviour is Behaviour.SCALED_JOINT_TRAJECTORY or bool(
            controller.parameters.get("speed_scaling.state_interface")
        )
        if reads and controller.device is not None and controller.device not in scaling:
            message = f"`{controller.name}` follows a speed scaling that `{controller.device}` does not have"
            yield found(graph, controller.path, message)
