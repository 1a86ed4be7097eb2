"""A trajectory may end while the arm still moves.

The controller then takes trajectories whose last point has a velocity. At that point the command stops and the arm does
not: it is stopped within one update, or overshoots into what is behind the goal.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory:
      parameters: {allow_nonzero_velocity_at_trajectory_end: true}  # expect at allow_nonzero_velocity_at_trajectory_end
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory:
      parameters: {allow_nonzero_velocity_at_trajectory_end: false}
```

Fix: write false, and let the planner end every trajectory at rest.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): allow_nonzero_velocity_at_trajectory_end
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES

_PARAMETER = "allow_nonzero_velocity_at_trajectory_end"


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers that accept such trajectories."""
    for controller in graph.cell.controllers:
        if controller.behaviour in TRAJECTORIES and controller.written_parameters.get(_PARAMETER) is True:
            message = f"trajectories of `{controller.name}` must end at rest, but it takes those that do not"
            yield found(graph, (*controller.path, "parameters", _PARAMETER), message)
