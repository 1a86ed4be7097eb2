"""A trajectory controller does not watch the joints on their way.

Without a tolerance the controller goes on while a joint is blocked, and the command runs away from the arm.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: null}  # expect at arm_trajectory
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 0.2 rad}
```

Fix: add `path_tolerance:`, such as `0.2 rad`.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): constraints.<joint>.trajectory, where 0 means not checked
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule
from cellc.compiler.rules.tolerances import unwatched_joints


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without the value, and with zero, which switches the check off."""
    yield from unwatched_joints(graph, "path_tolerance")
