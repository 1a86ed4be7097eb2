"""A goal can be reached only in a singularity.

In every configuration that puts the tip there the arm has lost a direction: it is stretched out, or two axes are in
line. A straight motion would ask a joint for a speed without bound, and the controller stops.

Example that is reported:

```yaml
frames:
  edge: {parent: world, xyz: 813.75 100 850 mm, designed: true}
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

Fix: move the frame or the robot, or turn the goal.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield goals whose every solution is singular."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.failure == "singular":
            message = f"goal `{goal.name}` can be reached only in a singularity: {goal.detail}"
            yield found(graph, (*paths[goal.name], "frame"), message)
