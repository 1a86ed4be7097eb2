"""A goal uses the latest transform.

The latest transform belongs to another moment than the image: the arm, and with it a wrist camera, has moved on
since. The error is as large as the motion in between and shows only when the robot is fast.

Example that is reported:

```yaml
motion:
  goals:
    regrasp: {frame: object, rpy: 180 0 0 deg, transform_at: latest}  # expect at transform_at
```

Example that is accepted:

```yaml
motion:
  goals:
    regrasp: {frame: object, rpy: 180 0 0 deg, transform_at: observation}
```

Fix: remove the line: the stamp of the observation is the default.

Source: docs/principles.md#transforms-at-the-time-of-observation
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield goals that would be transformed at another time than their observation."""
    for goal in graph.cell.goals:
        if goal.transform_at == "latest":
            message = f"goal `{goal.name}` asks for the latest transform of `{goal.frame}`"
            yield found(graph, (*goal.path, "transform_at"), message)
