"""An approach is shorter than a millimeter or longer than any arm.

One that short has no effect, most often meters written as mm: the tool comes from the side. One of meters is mm read as
m.

Example that is reported:

```yaml
motion:
  goals: {pick: {frame: object, approach: 0 0 -100 m}}  # expect at approach
```

Example that is accepted:

```yaml
motion:
  goals: {pick: {frame: object, approach: 0 0 -100 mm}}
```

Fix: check the unit, or leave the approach out.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_SHORTEST_M = 0.001
_LONGEST_M = 1.0


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield approaches below 1 mm, and above 1 m."""
    for goal in graph.cell.goals:
        length = None if goal.approach is None else math.hypot(*goal.approach)
        if length is not None and not _SHORTEST_M <= length <= _LONGEST_M:
            message = (
                f"the approach of goal `{goal.name}` must be from {_SHORTEST_M * 1e3:g} mm to {_LONGEST_M:g} m,"
                f" got {length * 1e3:g} mm"
            )
            yield found(graph, (*goal.path, "approach"), message)
