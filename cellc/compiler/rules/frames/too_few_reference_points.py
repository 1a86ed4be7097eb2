"""A fixture has fewer than three known points.

One or two points fit a transform that is mirrored, turned or scaled. Three points that are not in a line prove
direction and scale before the robot goes there.

Example that is reported:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, calibration: tray, reference_points: 2}  # expect at reference_points
```

Example that is accepted:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, calibration: tray, reference_points: 3}
```

Fix: mark three points on the fixture, measure them, and write `reference_points: 3`.

Source: docs/principles.md#direction-and-scale
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LEAST = 3


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield measured frames that goals rest on, or that count points, with fewer than three."""
    targets = {goal.frame for goal in graph.cell.goals}
    for frame in graph.cell.frames:
        concerned = frame.name in targets or frame.reference_points > 0
        if frame.kind is FrameKind.FIXED and concerned and not frame.designed and frame.reference_points < _LEAST:
            message = f"`{frame.name}` must have at least {_LEAST} reference points, got {frame.reference_points}"
            path = (*frame.path, "reference_points")
            yield found(graph, path, message)
