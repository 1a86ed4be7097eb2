"""A goal lies near a singularity.

The arm gets there, but slowly: what the tip moves in the lost direction a joint must move many times over, and small
errors of calibration become large motions of a joint.

Example that is reported:

```yaml
frames:
  edge: {parent: world, xyz: 806 100 850 mm, designed: true}
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

_LEAST = 0.05


@rule(Severity.WARNING, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield goals below the least singular value that leaves room."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        least = goal.min_singular_value
        if least is not None and least < _LEAST:
            message = f"the least singular value at goal `{goal.name}` must be at least {_LEAST:g}, got {least:.2g}"
            yield found(graph, (*paths[goal.name], "frame"), message)
