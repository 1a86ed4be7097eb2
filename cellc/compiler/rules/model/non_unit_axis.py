"""The axis of a moving joint is not of unit length.

Some libraries normalize the axis, others multiply the joint position by its length, so that the same model moves by
different amounts in the planner, in the viewer and in the controller.

Example that is reported:

```xml
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 2"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
</joint>
```

Example that is accepted:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0.6 0.8"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
</joint>
```

Fix: divide the vector by its length.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): the vector of an axis is normalized
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule

_TOLERANCE = 1e-3  # axes are often written with three or four digits


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield axes whose length is neither zero, which is another mistake, nor one."""
    for part in graph.model.joints():
        length = math.hypot(*part.joint.axis)
        if part.joint.movable and length > 0.0 and abs(length - 1.0) > _TOLERANCE:
            message = f"the axis of joint `{part.joint.name}` must have length 1, got {length:g}"
            unit = " ".join(f"{component / length:.6g}" for component in part.joint.axis)
            yield Finding(message, part.span, part.path, f"write `{unit}` if the direction is right")
