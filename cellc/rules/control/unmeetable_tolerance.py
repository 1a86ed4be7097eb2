"""A tolerance is below what a healthy joint can keep.

A joint is one update behind its command: at full speed that alone is the speed times the period. A tolerance below it
aborts every fast motion. One below what a joint can be held at is never met, and every goal ends as a failure.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 0.0005 rad, goal_tolerance: 0.0001 rad}  # expect at path_tolerance
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 0.2 rad, goal_tolerance: 0.01 rad}
```

Fix: write at least what one late update costs at full speed, and for a goal what the joint repeats.

Source: https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
(Jazzy): constraints, compared with the state of the same update
"""

from __future__ import annotations

from cellc.cell.control import Controller
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.vocabulary import TRAJECTORIES

_HELD = 1e-4
"""Rad or m: a tenth of a millimeter at a meter, about what industrial arms repeat."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield path tolerances below one update at full speed, and goal tolerances below what arms repeat."""
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.behaviour not in TRAJECTORIES:
                continue
            behind = _fastest(graph, controller) / manager.update_rate_hz if manager.update_rate_hz else 0.0
            least = (
                ("path_tolerance", controller.path_tolerance, behind, "one update at full speed"),
                ("goal_tolerance", controller.goal_tolerance, _HELD, "what arms repeat"),
            )
            for key, value, bound, why in least:
                if value is not None and 0.0 < value < bound:
                    path = (*controller.path, key)
                    message = f"`{key}` of `{controller.name}` must be at least {bound:.2g} rad or m, {why},"
                    yield found(graph, path, f"{message} got {graph.cell.text(*path)}")


def _fastest(graph: CellGraph, controller: Controller) -> float:
    joints = [joint for device in graph.cell.devices for joint in device.joints if joint.name in controller.joints]
    return max((joint.velocity for joint in joints if joint.velocity is not None), default=0.0)
