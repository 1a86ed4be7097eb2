"""A goal puts a joint next to its limit.

A little farther and the goal has no solution, or the arm must turn all the way round to the other one. Where a part
lies a few millimeters aside, or the calibration is measured again, the motion fails.

Example that is reported:

```yaml
motion:
  poses: {home: {manipulator: 350 -90 90 -90 -90 0 deg}}
# expect at motion.goals.place.frame
```

Example that is accepted:

```yaml
motion:
  poses: {home: {manipulator: 0 -90 90 -90 -90 0 deg}}
```

Fix: begin nearer to the middle of the joint's range, or move the goal.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LEAST_SHARE = 0.02


@rule(Severity.WARNING, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield goals that leave one joint less than its share of room."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.limit_joint and goal.limit_share < _LEAST_SHARE:
            message = (
                f"goal `{goal.name}` must leave `{goal.limit_joint}` {_LEAST_SHARE:.0%} of its range to the limit, "
                f"got {goal.limit_share:.1%} ({goal.limit_distance:.2g})"
            )
            yield found(graph, (*paths[goal.name], "frame"), message)
