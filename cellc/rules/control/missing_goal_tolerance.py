"""A trajectory controller does not check where the joints end.

Without a tolerance every trajectory succeeds, wherever the arm is when its time is over.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {goal_tolerance: null}  # expect at arm_trajectory
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {goal_tolerance: 0.01 rad}
```

Fix: state `goal_tolerance:`.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): constraints.<joint>.goal, where 0 means not checked
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.vocabulary import TRAJECTORIES


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without the value, and with zero, which switches the check off."""
    for controller in graph.cell.controllers:
        if controller.behaviour not in TRAJECTORIES:
            continue
        if not controller.goal_tolerance:
            stated = "does not state" if controller.goal_tolerance is None else "switches off, with zero, its"
            path = controller.path if controller.goal_tolerance is None else (*controller.path, "goal_tolerance")
            message = f"`{controller.name}` {stated} `goal_tolerance`"
            yield found(graph, path, message, "add `goal_tolerance:`, such as `0.01 rad`")
