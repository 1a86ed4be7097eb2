"""A trajectory controller ignores the speed scaling of its device.

The slider or the reduced mode slows the arm while the controller's clock runs on. The following error grows until the
tolerance aborts the goal, or the arm jumps when the slider is opened.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {type: joint_trajectory}  # expect at type
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {type: scaled_joint_trajectory}
```

Fix: use the scaled trajectory controller of the device.

Source: docs/principles.md#speed-scaling
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import Behaviour


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers on a scaling device that do not read its factor."""
    scaling = {device.name: device for device in graph.cell.devices if device.speed_scaling is not None}
    for controller in graph.cell.controllers:
        if controller.behaviour is not Behaviour.JOINT_TRAJECTORY or controller.device not in scaling:
            continue
        if not controller.parameters.get("speed_scaling.state_interface"):
            message = f"`{controller.device}` scales its speed, `{controller.name}` does not follow"
            kinds = [kind for kind in scaling[controller.device].controller_kinds if "trajectory" in kind]
            advice = f"use `type: {kinds[0]}`" if kinds else "use a controller that reads the scaling factor"
            yield found(graph, (*controller.path, "type"), message, advice)
