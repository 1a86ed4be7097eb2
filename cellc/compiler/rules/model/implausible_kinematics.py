"""The kinematics of a robot are not those of its type.

Robots of one type differ by fractions of a millimeter and of a degree. A joint that lies centimeters from where the
type has it is of another type, in another unit, or of a file that was edited; the driver compares a hash, not the
figures.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./measured_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             calibration: {file: measured_arm/other_arm.yaml, measured: 2026-07-01, owner: robot}}  # expect at file
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./measured_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0,
             calibration: {file: measured_arm/side_arm.yaml, measured: 2026-07-01, owner: robot}}
```

Fix: name the file that was read from the installed robot.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_OFFSET_M = 0.02
_TURN_RAD = math.radians(2.0)
"""Own choice: ten times what robots of one type differ by, and less than types do."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield devices with a joint that is far from where its type has it."""
    for device in graph.cell.devices:
        one = None if device.kinematics is None else device.kinematics.calibration
        if one is not None and (one.offset_m > _OFFSET_M or one.turn_rad > _TURN_RAD):
            differs = f"{one.offset_m * 1000.0:.0f} mm and {math.degrees(one.turn_rad):.1f} deg"
            allowed = f"{_OFFSET_M * 1000.0:.0f} mm and {math.degrees(_TURN_RAD):.0f} deg"
            message = f"`{one.name}` must lie within {allowed} of the type `{device.model}`, differs by {differs}"
            yield found(graph, (*device.path, "calibration", "file"), message)
