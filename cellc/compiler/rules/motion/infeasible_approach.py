"""No straight line leads to a goal.

The goal itself can be reached, its approach cannot: the pose before it is out of reach, something is in the way, or the
arm would must change its posture on the line.

Example that is reported:

```yaml
motion:
  goals: {place: {frame: fixture_A, rpy: 180 0 0 deg, approach: 0 0 -900 mm}}  # expect at approach
```

Example that is accepted:

```yaml
motion:
  goals: {place: {frame: fixture_A, rpy: 180 0 0 deg, approach: 0 0 -100 mm}}
```

Fix: shorten or turn the approach; it is given in the tip's own axes.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS, in_the_chain
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield goals that are reached, but not along their approach."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.approach_failure:
            message = f"no straight line leads to goal `{goal.name}`: {goal.approach_failure}"
            related = in_the_chain(graph, goal.name)
            yield found(graph, (*paths[goal.name], "approach"), message, related=related)
