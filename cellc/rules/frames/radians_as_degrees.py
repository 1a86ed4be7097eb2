"""An angle is a fraction of pi, written in degrees.

Programs print 1.5708 for a quarter turn. With `deg` behind it the same number is a tilt that nobody sees: a gripper
that was to point down points forward, a pose that was copied from `/joint_states` stands nearly at zero.

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
from collections.abc import Iterator

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule

_DEGREES = re.compile(r"[-+0-9.,\s]*\d\s*deg\s*")
_NUMBER = re.compile(r"\d+\.(\d{3,})")
_PARTS = tuple(math.pi * numerator / 12 for numerator in (2, 3, 4, 6, 8, 9, 10, 12, 18, 24))
"""What programs print for 30, 45, 60, 90, 120, 135, 150, 180, 270 and 360 degrees."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield values in degrees with a number that is such a fraction of pi to its last digit."""
    for path, text in graph.cell.places.texts.items():
        number = next(_radians(text), None) if _DEGREES.fullmatch(text) else None
        if number is not None:
            degrees = math.degrees(float(number))
            message = f"`{path[-1]}` must be in degrees, got `{text}`, where {number} is {degrees:.0f} deg in radians"
            yield found(graph, path, message)


def _radians(text: str) -> Iterator[str]:
    """Yield the numbers of three decimals or more that are a fraction of pi, rounded or cut at their last digit."""
    for number in _NUMBER.finditer(text):
        last_digit = 10.0 ** -len(number[1])
        if any(abs(float(number[0]) - part) < last_digit for part in _PARTS):
            yield number[0]
