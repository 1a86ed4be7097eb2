"""A named pose lies outside the joint limits.

The planner refuses the pose, or the controller clamps it and the arm is elsewhere than its name says. Degrees
read as radians are the usual reason.

Example that is reported:

```yaml
motion:
  poses: {home: {manipulator: 0 -400 90 -90 -90 0 deg}}  # expect at manipulator
```

Example that is accepted:

```yaml
motion:
  poses: {home: {manipulator: 0 -90 90 -90 -90 0 deg}}
```

Fix: correct the value, and check its unit.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("unit-of-another-joint",))
def check(graph: CellGraph) -> Findings:
    """Yield each joint of a pose that is below its lower or above its upper limit."""
    joints = {joint.name: joint for device in graph.cell.devices for joint in device.joints}
    for pose in graph.cell.poses:
        if len(pose.joints) != len(pose.positions):
            continue
        for name, position in zip(pose.joints, pose.positions, strict=True):
            joint = joints.get(name)
            if joint is None or joint.lower is None or joint.upper is None:
                continue
            if not joint.lower <= position <= joint.upper:
                allowed = f"between {joint.lower:.4g} and {joint.upper:.4g}"
                message = f"`{name}` must be {allowed} in pose `{pose.name}`, got {position:.4g}"
                yield found(graph, pose.path, message, related=described(graph, [name]))
