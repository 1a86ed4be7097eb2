"""Shapes cannot be read, so that collisions are not checked.

The kinematics refuses the robot description, most often because it names a mesh that cannot be found. Poses and goals
are then not checked, the semantic description lists neighbors alone, and the mock does not plan.

Example that is reported:

```xml
<link name="tool">
  <collision><geometry><mesh filename="package://nowhere/tool.stl"/></geometry></collision>
</link>
<!-- expect at motion.groups -->
```

Example that is accepted:

```xml
<link name="tool">
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
```

Fix: give collision shapes as boxes, cylinders and spheres.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.feasibility import motion_answer
from cellc.rules.geometry import SOUND_MODEL
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=SOUND_MODEL)
def check(graph: CellGraph) -> Findings:
    """Yield the reason for which the description is refused."""
    refused = motion_answer(graph).refused
    if refused:
        message = f"poses and goals are not checked: {refused}"
        yield found(graph, ("motion", "groups"), message)
