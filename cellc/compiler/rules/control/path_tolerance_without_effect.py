"""A path tolerance is so wide that it watches nothing.

A value that was raised until the error disappeared lets the arm lag behind its command by a whole motion. A collision
is then noticed at the end of the trajectory, if at all.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 3.2 rad}  # expect at path_tolerance
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {path_tolerance: 0.2 rad}
```

Fix: find out why the arm lags, and write what a healthy motion needs, such as `0.2 rad`.

Source:

- https://control.ros.org/jazzy/doc/ros2_controllers/joint_trajectory_controller/doc/parameters.html
  (Jazzy): constraints.<joint>.trajectory
- docs/principles.md#planning-and-execution
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES

_SHARE_OF_RANGE = 0.5
_WIDEST_RAD = 1.0


@rule(Severity.ERROR, assumes=("unit-of-another-joint",))
def check(graph: CellGraph) -> Findings:
    """Yield trajectory controllers whose tolerance exceeds half of a joint's range, or 1 rad."""
    joints = {joint.name: joint for device in graph.cell.devices for joint in device.joints}
    for controller in graph.cell.controllers:
        if controller.behaviour not in TRAJECTORIES or controller.path_tolerance is None:
            continue
        bounds = _bounds(joints, controller)
        wide = [(bounds[name], name) for name, one in controller.path_tolerance.items() if one.value > bounds[name]]
        if wide:
            widest, joint = min(wide)
            path = (*controller.path, "path_tolerance")
            written = graph.cell.text(*path) or f"{controller.path_tolerance[joint].value:g}"
            message = f"`path_tolerance` of `{controller.name}` must be at most {widest:.3g} rad or m, half of"
            message += f" what `{joint}` moves or 1 rad, got {written}"
            yield found(graph, path, message, related=described(graph, [joint]))


def _bounds(joints: Mapping[str, DeviceJoint], controller: Controller) -> dict[str, float]:
    """Return the widest tolerance of each joint in rad or m; no bound where a joint has no limits."""
    bounds = dict.fromkeys(controller.joints, math.inf)
    for joint in (joints[name] for name in bounds if name in joints):
        if joint.lower is not None and joint.upper is not None:
            bound = _SHARE_OF_RANGE * (joint.upper - joint.lower)
            bounds[joint.name] = bound if joint.slides else min(bound, _WIDEST_RAD)
    return bounds
