"""The arm starts towards a goal from a singular pose.

Stretched, or with two wrist axes in line, an arm cannot begin a straight line in every direction: the planner fails or
turns joints by half a turn. Joint values in the order of `/joint_states`, which is alphabetical, often end here.

Example that is reported:

```yaml
motion:
  poses:
    home: {manipulator: 0 -90 0 -90 0 0 deg}  # expect at home.manipulator
  goals: {pick: {approach: null}, place: {approach: null}}
```

Example that is accepted:

```yaml
motion:
  poses:
    home: {manipulator: 0 -90 90 -90 -90 0 deg}
```

Fix: bend elbow and wrist, and check that the values stand in the order of the joints of the group.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from itertools import pairwise

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LEAST = 0.02


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def check(graph: CellGraph) -> Findings:
    """Yield poses from which a rehearsal goes to a goal and in which the tip can lose a direction."""
    groups = {goal.name: goal.group for goal in graph.cell.goals}
    starts = {
        (before, groups[after])
        for rehearsal in graph.cell.rehearsals
        for before, after in pairwise(step.name for step in rehearsal.steps if step.kind == "move")
        if after in groups
    }
    paths = {(pose.name, pose.group): pose.path for pose in graph.cell.poses}
    for pose in motion_answer(graph).poses:
        for group, least in pose.least:
            if least < _LEAST and (pose.name, group) in starts:
                message = f"the least singular value in pose `{pose.name}`, from which `{group}` goes to a goal,"
                message += f" must be at least {_LEAST:g}, got {least:.2g}"
                yield found(graph, paths[pose.name, group], message)
