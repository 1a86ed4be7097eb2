"""A trajectory controller has no bound on reaching its goal.

With a goal time of zero the controller waits forever for a joint that does not arrive. The action neither succeeds
nor fails, and the task behind it waits too.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {goal_time: null}  # expect at arm_trajectory
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {goal_time: 1 s}
```

Fix: add `goal_time:`, such as `1 s`.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): constraints.goal_time, where 0 means no limit
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without the value, and with zero, which switches the check off."""
    for controller in graph.cell.controllers:
        if controller.behaviour not in TRAJECTORIES:
            continue
        if not controller.goal_time_s:
            unstated = controller.goal_time_s is None
            path = controller.path if unstated else (*controller.path, "goal_time")
            message = f"`{controller.name}` does not state `goal_time`"
            if not unstated:
                message = f"`goal_time` of `{controller.name}` must be above zero, which switches the check off"
            yield found(graph, path, message)
