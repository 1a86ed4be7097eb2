"""No joint positions put the tip at a goal.

The place is near enough, but not in this orientation, or only outside the joint limits. The planner says so when the
part already lies there.

Example that is reported:

```yaml
frames:
  edge: {parent: world, xyz: 820 100 850 mm, designed: true}
motion:
  goals: {fetch: {frame: edge, rpy: 180 0 0 deg}}  # expect at frame
```

Example that is accepted:

```yaml
frames:
  edge: {parent: world, xyz: 700 100 850 mm, designed: true}
motion:
  goals: {fetch: {frame: edge, rpy: 180 0 0 deg}}
```

Fix: move the frame or the robot, or turn the goal: the tip's z points into the part.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS, in_the_chain
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield goals for which the search ended away from the target."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.failure in ("no_ik_solution", "out_of_limits"):
            message = f"no joint positions were found for goal `{goal.name}`: {goal.detail}"
            yield found(graph, (*paths[goal.name], "frame"), message, related=in_the_chain(graph, goal.name))
