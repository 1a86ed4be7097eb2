"""The first motion is too fast or too far.

Gate G6 is a small move at reduced speed, so that a wrong sign is seen before it matters.

Example that is reported:

```yaml
bringup:
  first_motion:
    joint: arm/joint_6
    direction: +
    max_delta: 90 deg  # expect at max_delta
    velocity: 5 deg/s
    timeout: 20 s
    stop_if: [wrong direction]
```

Example that is accepted:

```yaml
bringup:
  first_motion:
    joint: arm/joint_6
    direction: +
    max_delta: 5 deg
    velocity: 5 deg/s
    timeout: 5 s
    stop_if: [wrong direction]
```

Fix: stay below 15 deg (or 50 mm) and 15 deg/s (or 50 mm/s).

Source: docs/principles.md#the-first-motion
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_LARGEST_RAD = math.radians(15.0)
_LARGEST_M = 0.05


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a delta or velocity above the bound of a first motion."""
    motion = graph.cell.bringup.first_motion
    if motion is None:
        return
    for field, value in (("max_delta", motion.max_delta), ("velocity", motion.velocity)):
        if value.value > (_LARGEST_M if value.linear else _LARGEST_RAD):
            path = ("bringup", "first_motion", field)
            largest = "50 mm" if value.linear else "15 deg"
            per = " per second" if field == "velocity" else ""
            allowed, written = f"{largest}{per}", graph.cell.text(*path)
            message = f"`{field}` of the first motion must be at most {allowed}, got {written}"
            yield found(graph, path, message, f"write at most {largest}{per}")
