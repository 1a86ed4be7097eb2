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

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule
from cellc.compiler.rules.tolerances import stated


@rule(Severity.ERROR, assumes=("parameter-out-of-range",))
def check(graph: CellGraph) -> Findings:
    """Yield tolerances and constraints of controllers that are negative."""
    for controller in graph.cell.controllers:
        least: dict[YamlPath, float] = {
            (key,): min(figure.value for figure in figures.values()) for key, figures in stated(controller) if figures
        }
        for name, written in controller.written_parameters.items():
            watched = "tolerance" in name or name.startswith("constraints.")
            if watched and isinstance(written, int | float):
                least["parameters", name] = written
        for at, value in least.items():
            if value < 0:
                path = (*controller.path, *at)
                text = graph.cell.text(*path) or f"{value:g}"
                yield found(graph, path, f"`{at[-1]}` of `{controller.name}` must be above zero, got {text}")
