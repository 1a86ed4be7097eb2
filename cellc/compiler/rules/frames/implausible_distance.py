"""A frame lies farther from its parent than any cell is long.

A fixture 400 m away is 400 mm read as meters. TF, planner and viewer accept it; the goal is then out of reach for a
reason that no message names.

Example that is reported:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, xyz: 400 100 850 m, calibration: tray}  # expect at xyz
```

Example that is accepted:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, xyz: 400 100 850 mm, calibration: tray}
```

Fix: check the unit: most drawings of cells are in mm.

Source:

- docs/principles.md#direction-and-scale
- docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LARGEST_CELL_M = 20.0


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield frames more than 20 m from their parent."""
    for frame in graph.cell.frames:
        if frame.transform_to_parent is None:
            continue
        distance = math.hypot(*frame.transform_to_parent.position)
        if distance > _LARGEST_CELL_M:
            message = f"`{frame.name}` must lie within {_LARGEST_CELL_M:g} m of `{frame.parent}`, got {distance:g} m"
            yield found(graph, (*frame.path, "xyz"), message)
