"""An approach is of length zero or longer than any arm.

An approach of zero is none, and one of meters is mm read as m.

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

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule

_LONGEST_M = 1.0


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield approaches of no length, and above 1 m."""
    for goal in graph.cell.goals:
        length = None if goal.approach is None else math.hypot(*goal.approach)
        if length is not None and not 0.0 < length <= _LONGEST_M:
            message = (
                f"the approach of goal `{goal.name}` must be above 0 m and at most {_LONGEST_M:g} m, got {length:g} m"
            )
            yield found(graph, (*goal.path, "approach"), message)
