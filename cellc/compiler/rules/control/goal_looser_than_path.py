"""A controller allows more error at the end than on the way.

A joint that ends inside the goal tolerance has left the path tolerance before, so the goal is aborted for a reason
that the looser figure hides.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 0.05 rad, goal_tolerance: 0.1 rad}  # expect at goal_tolerance
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 0.2 rad, goal_tolerance: 0.1 rad}
```

Fix: swap the two, or tighten the goal tolerance.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): constraints.<joint>.goal and constraints.<joint>.trajectory
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=("unit-of-another-joint",))
def check(graph: CellGraph) -> Findings:
    """Yield controllers whose goal tolerance exceeds the path tolerance."""
    for controller in graph.cell.controllers:
        path = controller.path_tolerance or {}
        looser = (
            (goal.value, path[joint].value)
            for joint, goal in (controller.goal_tolerance or {}).items()
            if joint in path and goal.value > path[joint].value > 0.0
        )
        for goal, way in dict.fromkeys(looser):
            message = f"`goal_tolerance` of `{controller.name}` must be at most its `path_tolerance`"
            yield found(graph, (*controller.path, "goal_tolerance"), f"{message} of {way:g}, got {goal:g}")
