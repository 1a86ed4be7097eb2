"""A joint limit in radians looks like degrees.

URDF holds angles in radians. A limit of 180 means 28 turns: nothing in the model stops the joint, and the planner
winds up the cables.

Example that is reported:

```xml
<joint name="turn" type="revolute">  <!-- expect -->
  <parent link="base"/> <child link="arm"/> <axis xyz="0 0 1"/>
  <limit lower="-180" upper="180" velocity="1" effort="10"/>
</joint>
```

Example that is accepted:

```xml
<joint name="turn" type="revolute">
  <parent link="base"/> <child link="arm"/> <axis xyz="0 0 1"/>
  <limit lower="-3.14" upper="3.14" velocity="1" effort="10"/>
</joint>
```

Fix: convert the limits to radians; a joint without ends is `continuous`.

Source:

- https://www.ros.org/reps/rep-0103.html (as of 2025-10-24): angles are in rad
- docs/principles.md#robot-descriptions
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule

_FOUR_TURNS = 8.0 * math.pi


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield revolute joints that could turn more than four times to one side."""
    for part in graph.model.joints():
        limit = part.joint.limit
        if part.joint.type != "revolute" or limit is None:
            continue
        largest = max(abs(limit.lower or 0.0), abs(limit.upper or 0.0))
        if largest > _FOUR_TURNS:
            turns = largest / (2.0 * math.pi)
            message = f"joint `{part.joint.name}` has a limit of {largest:g} rad, which is {turns:.1f} turns"
            yield Finding(
                message, part.span, part.path, f"write {math.radians(largest):.6g} if {largest:g} is in degrees"
            )
