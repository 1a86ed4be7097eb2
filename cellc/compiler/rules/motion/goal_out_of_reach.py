"""A goal lies farther away than the arm is long.

The distance from the base to the goal exceeds the sum of all links, tool included: no joint position reaches it,
whatever the planner tries.

Example that is reported:

```yaml
frames:
  far: {parent: world, xyz: 3000 0 800 mm, designed: true}
motion:
  goals: {fetch: {frame: far}}  # expect at frame
```

Example that is accepted:

```yaml
frames:
  near: {parent: world, xyz: 400 0 900 mm, designed: true}
motion:
  goals: {fetch: {frame: near}}
```

Fix: check parent, sign and unit of the frame.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

import math

from cellc.compiler.cell.motion import PlanningGroup
from cellc.compiler.rules.geometry import in_the_chain
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Pose, identity


@rule(Severity.ERROR, assumes=("frame-cycle",))
def check(graph: CellGraph) -> Findings:
    """Yield goals in static frames beyond the stretched length of their group."""
    groups = {group.name: group for group in graph.cell.groups}
    for goal in graph.cell.goals:
        group = groups.get(goal.group)
        target = None if group is None else _pose_in_world(graph, goal.frame)
        base = None if group is None else _pose_in_world(graph, group.base_link)
        if group is None or target is None or base is None:
            continue
        place = (target @ goal.transform_tip_to_frame).position
        distance = math.dist(place, base.position)
        length = _stretched(graph, group)
        if distance > length:
            message = (
                f"goal `{goal.name}` is {distance:.3g} m from `{group.base_link}`, but the chain is {length:.3g} m long"
            )
            related = in_the_chain(graph, goal.name)
            yield found(graph, (*goal.path, "frame"), message, related=related)


def _pose_in_world(graph: CellGraph, name: str) -> Pose | None:
    """Return the pose of a frame that does not move, or None."""
    pose = identity()
    for frame in graph.frames.chain(name):
        if frame.moving or frame.transform_to_parent is None:
            return None
        pose = frame.transform_to_parent @ pose
    return pose


def _stretched(graph: CellGraph, group: PlanningGroup) -> float:
    """Return the sum of the lengths from base to tip, and of the travel of prismatic joints, in meters."""
    length = 0.0
    for frame in graph.frames.chain(group.tip_frame):
        if frame.name == group.base_link:
            break
        length += math.hypot(*frame.transform_to_parent.position) if frame.transform_to_parent else 0.0
    joints = [joint for device in graph.cell.devices for joint in device.joints if joint.name in group.joints]
    travel = (max(abs(j.lower or 0.0), abs(j.upper or 0.0)) for j in joints if j.type == "prismatic")
    return length + sum(travel)
