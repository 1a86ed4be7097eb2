"""A joint of a planning group has no acceleration or jerk limit, or no way to go.

A planner times a path by the limits of velocity, acceleration and jerk, and samples between the position limits. MoveIt
of Jazzy and later finds a path for such a joint and then fails to time it, that of Humble guesses 1 rad/s^2; the mock
does not load such a group.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./bare_arm_with_tool, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
control: {controllers: {side: {type: joint_trajectory, device: side_arm, client: task,
                               goal_time: 1 s, path_tolerance: 0.1 rad, goal_tolerance: 0.1 rad}}}
motion: {groups: {side: {base: side_arm/base, tip: side_arm/tool0}}}  # expect at side
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
control: {controllers: {side: {type: joint_trajectory, joints: [side_arm/turn], device: side_arm, client: task,
                               goal_time: 1 s, path_tolerance: 0.1 rad, goal_tolerance: 0.1 rad}}}
motion: {groups: {side: {base: side_arm/base, tip: side_arm/arm}}}
```

Fix: state `acceleration` and `jerk` under `limits:` of `device.yaml`, and a range in the `<limit>` of the joint.

Source:

- https://github.com/moveit/moveit2/blob/2.12.4/moveit_core/trajectory_processing/src/time_optimal_trajectory_generation.cpp
  (2.12.4): "No acceleration limit was defined for joint"
- docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("missing-joint-limits", "missing-velocity-limit", "reversed-limits"))
def check(graph: CellGraph) -> Findings:
    """Yield joints of planning groups without the limits that a planner needs."""
    joints = {joint.name: joint for device in graph.cell.devices for joint in device.joints}
    for group in graph.cell.groups:
        for joint in (joints[name] for name in group.joints if name in joints):
            if lacks := " and no ".join(_lacking(joint)):
                message = f"joint `{joint.name}` of group `{group.name}` has no {lacks}"
                yield found(graph, group.path, message, related=described(graph, [joint.name]))


def _lacking(joint: DeviceJoint) -> Iterator[str]:
    for name, limit in (("velocity", joint.velocity), ("acceleration", joint.acceleration), ("jerk", joint.jerk)):
        if limit is None:
            yield f"{name} limit"
    if joint.type != "continuous" and joint.lower is not None and joint.lower == joint.upper:
        yield f"range: both limits are {joint.lower:g}"
