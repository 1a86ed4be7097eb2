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

Fix: add `goal_tolerance:`, such as `0.01 rad`.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): constraints.<joint>.goal, where 0 means not checked
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule
from cellc.compiler.rules.tolerances import unwatched_joints


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without the value, and with zero, which switches the check off."""
    yield from unwatched_joints(graph, "goal_tolerance")
