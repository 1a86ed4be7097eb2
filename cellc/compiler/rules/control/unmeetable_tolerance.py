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

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.control import Controller
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.compiler.rules.tolerances import stated
from cellc.contract.vocabulary import TRAJECTORIES

_HELD = 1e-4
"""Rad or m: a tenth of a millimeter at a meter, about what industrial arms repeat."""


@rule(Severity.WARNING, assumes=("unit-of-another-joint",))
def check(graph: CellGraph) -> Findings:
    """Yield path tolerances below one update at full speed, and goal tolerances below what arms repeat."""
    speeds = {joint.name: joint.velocity or 0.0 for device in graph.cell.devices for joint in device.joints}
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.behaviour not in TRAJECTORIES:
                continue
            for key, bound, why in _unmet(speeds, controller, manager.update_rate_hz):
                path = (*controller.path, key)
                message = f"`{key}` of `{controller.name}` must be at least {bound:.2g} rad or m, {why},"
                yield found(graph, path, f"{message} got {graph.cell.text(*path) or 'less'}")


def _unmet(speeds: Mapping[str, float], controller: Controller, rate_hz: float) -> Iterator[tuple[str, float, str]]:
    """Yield each key whose figure is too small for some joint, with the largest bound of those joints, and why."""
    for key, figures in stated(controller):
        bounds = {joint: speeds.get(joint, 0.0) / rate_hz if rate_hz else 0.0 for joint in figures or {}}
        bounds = bounds if key == "path_tolerance" else dict.fromkeys(bounds, _HELD)
        missed = [bounds[joint] for joint, one in (figures or {}).items() if 0.0 < one.value < bounds[joint]]
        if missed:
            yield key, max(missed), "one update at full speed" if key == "path_tolerance" else "what arms repeat"
