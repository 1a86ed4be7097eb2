"""A moving joint has an axis of length zero.

The joint has no direction to move in. URDF libraries load it; kinematics then yields NaN or a joint that does not move
while its position counts up.

Example that is reported:

```xml
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 0"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
</joint>
```

Example that is accepted:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
</joint>
```

Fix: write the unit vector of the motion in the joint frame, such as `0 0 1`.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): the vector of an axis is normalized
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield joints that have no direction."""
    for part in graph.model.joints():
        if part.joint.movable and math.hypot(*part.joint.axis) == 0.0:
            message = f"joint `{part.joint.name}` is {part.joint.type} but its axis is `0 0 0`"
            yield Finding(message, part.span, part.path)
