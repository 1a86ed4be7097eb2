"""Shapes cannot be read, so that collisions are not checked.

The kinematics refuses the robot description, most often because a figure of a joint has a sign or a size that no
kinematics can use. Poses and goals are then not checked, and neither the mock nor another program takes the
description.

Example that is reported:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
  <dynamics friction="-1"/>
</joint>
<!-- expect at motion.groups -->
```

Example that is accepted:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
  <dynamics friction="1"/>
</joint>
```

Fix: write in the description what the message names.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import SOUND_MODEL, USABLE_MESHES
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, *USABLE_MESHES, "geometry-too-large"))
def check(graph: CellGraph) -> Findings:
    """Yield the reason for which the description is refused."""
    refused = motion_answer(graph).refused
    if refused:
        message = f"poses and goals are not checked: {refused}"
        yield found(graph, ("motion", "groups"), message)
