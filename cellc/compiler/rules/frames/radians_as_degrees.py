"""An angle is a fraction of pi, written in degrees.

Programs print 1.5708 for a quarter turn. With `deg` behind it the same number is a tilt too small to see: a gripper
that was to point down points forward, a pose that was copied from `/joint_states` is nearly zero. Such a pose
is known by its numbers too: printed ones, and none of them beyond a full turn in radians.

Example that is reported:

```yaml
frames:
  tray: {parent: world, xyz: 450 300 850 mm, rpy: 3.14159 0 0 deg, designed: true}  # expect at rpy
```

Example that is accepted:

```yaml
frames:
  tray: {parent: world, xyz: 450 300 850 mm, rpy: 3.14159 0 0 rad, designed: true}
```

Fix: write `rad`, or the angle in degrees.

Source: https://www.ros.org/reps/rep-0103.html (as of 2025-10-24): angles in ROS are radians
"""

from __future__ import annotations

import math
import re

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_DEGREES = re.compile(r"[-+0-9.,\s]*\d\s*deg\s*")
_NUMBER = re.compile(r"\d+(?:\.(\d*))?")
_QUARTERS = tuple(math.pi * numerator / 2 for numerator in (1, 2, 3, 4))
_PARTS = (*_QUARTERS, *(math.pi * numerator / 12 for numerator in (2, 3, 4, 8, 9, 10)))
"""What programs print for 90, 180, 270 and 360 degrees, and for 30, 45, 60, 120, 135 and 150."""
_JOINTS = 4
"""As many positions are those of an arm; a rotation and a translation have three numbers."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield values in degrees with a number that is a fraction of pi to its last digit, and arms that hardly turn."""
    for path, text in graph.cell.places.texts.items():
        why = _why(text) if _DEGREES.fullmatch(text) else None
        if why is not None:
            yield found(graph, path, f"`{path[-1]}` must be in degrees, got `{text}`, where {why}")


def _why(text: str) -> str | None:
    """Return what tells that numbers are radians; None where nothing does."""
    numbers = [(number[0], len(number[1] or "")) for number in _NUMBER.finditer(text)]
    for number, decimals in numbers:
        if _is_fraction(float(number), decimals):
            return f"{number} is {math.degrees(float(number)):.0f} deg in radians"
    printed = sum(decimals > 1 for _, decimals in numbers)
    if len(numbers) >= _JOINTS and printed > 1 and all(float(number) <= math.tau for number, _ in numbers):
        return f"{len(numbers)} joints stand within {math.tau:.2f} of zero, as positions in radians do"
    return None


def _is_fraction(number: float, decimals: int) -> bool:
    """Whether a number is a fraction of pi, rounded or cut at its last digit; a quarter turn is known by two."""
    digit = 10.0**-decimals
    parts = {2: _QUARTERS}.get(decimals, _PARTS if decimals > 2 else ())
    return any(-digit / 2 <= part - number < digit for part in parts)
