"""The robot is in collision at a goal.

Joint positions for the goal exist, but in none of them is the robot free: a link, the tool or the scene is in the way.
The planner refuses the goal.

Example that is reported:

```yaml
scene:
  crate: {parent: fixture_A, xyz: 0 0 100 mm, box: 200 200 200 mm}
# expect at motion.goals.place.frame
```

Example that is accepted:

```yaml
scene:
  crate: {parent: fixture_A, xyz: 0 0 -100 mm, box: 200 200 150 mm}
```

Fix: correct place and size of what is in the way, or move the goal.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS, in_the_chain
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield goals whose every solution is in collision, with what touches in the one nearest to the start."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.failure == "goal_in_collision":
            message = f"at goal `{goal.name}` {goal.detail}"
            yield found(graph, (*paths[goal.name], "frame"), message, related=in_the_chain(graph, goal.name))
