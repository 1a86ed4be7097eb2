"""A device that an arm carries is mounted far away from it.

No device is half a meter away from its flange without a bracket in the model. Meters
were read for millimeters or centimeters, or the pose belongs to another parent.

Example that is reported:

```yaml
devices:
  camera: {mount: {parent: arm/tool0, xyz: 0 -0.7 0.3 m, rpy: 0 -75 -90 deg, calibration: hand_eye}}  # expect at mount
```

Example that is accepted:

```yaml
devices:
  camera: {mount: {parent: arm/tool0, xyz: 0 -70 30 mm, rpy: 0 -75 -90 deg, calibration: hand_eye}}
```

Fix: check unit and parent of the mount, or model the bracket as a frame.

Source: docs/principles.md#direction-and-scale
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_FARTHEST_M = 0.5


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield devices whose root is more than 0.5 m from the frame of another device that carries it."""
    links = {link.name for device in graph.cell.devices for link in device.description.links}
    for device in graph.cell.devices:
        far_m = math.hypot(*device.transform_root_to_parent.position)
        if device.parent_frame in links and far_m > _FARTHEST_M:
            message = f"`{device.name}` must be within {_FARTHEST_M:g} m of `{device.parent_frame}`, which carries it,"
            yield found(graph, (*device.path, "mount"), f"{message} got {far_m:.2g} m")
