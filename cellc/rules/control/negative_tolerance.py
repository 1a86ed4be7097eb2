"""A tolerance is below zero.

The controller compares only with tolerances above zero. A negative one switches its check off, as zero does, without
looking like it.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory:
      parameters: {constraints.stopped_velocity_tolerance: -0.01}  # expect at constraints.stopped_velocity_tolerance
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory:
      parameters: {constraints.stopped_velocity_tolerance: 0.01}
```

Fix: write a tolerance above zero.

Source: https://github.com/ros-controls/ros2_controllers/blob/4.25.0/joint_trajectory_controller/include/joint_trajectory_controller/tolerances.hpp
(4.25.0): check_state_tolerance_per_joint compares where the tolerance is above 0
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("parameter-out-of-range",))
def check(graph: CellGraph) -> Findings:
    """Yield tolerances and constraints of controllers that are negative."""
    for controller in graph.cell.controllers:
        stated = {"path_tolerance": controller.path_tolerance, "goal_tolerance": controller.goal_tolerance}
        for key, value in (*stated.items(), *controller.written_parameters.items()):
            watched = "tolerance" in key or key.startswith("constraints.")
            if watched and isinstance(value, int | float) and value < 0:
                path = (*controller.path, *(() if key in stated else ("parameters",)), key)
                written = graph.cell.text(*path) or f"{value:g}"
                message = f"`{key}` of `{controller.name}` must be above zero, got {written}"
                yield found(graph, path, message)
