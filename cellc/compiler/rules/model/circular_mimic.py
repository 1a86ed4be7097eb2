"""A joint mimics itself, directly or through others.

No joint of the circle has a position of its own. Loaders accept it; a program that follows the leader never comes to
an end.

Example that is reported:

```xml
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
  <mimic joint="slide"/>
</joint>
```

Example that is accepted:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
  <mimic joint="turn"/>
</joint>
```

Fix: let every follower name the one joint that is driven.

Source:

- https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): element mimic
- docs/principles.md#robot-descriptions
"""

from __future__ import annotations

from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule
from cellc.robot.description.model import Description, Joint


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each joint from which following the leaders leads back to it."""
    for part in graph.model.joints():
        followed = _leaders(part.device.description, part.joint)
        if part.joint.name in followed:
            chain = " → ".join(f"`{name}`" for name in (part.joint.name, *followed))
            message = f"joint `{part.joint.name}` mimics itself: {chain}"
            others = [name for name in followed if name != part.joint.name]
            yield Finding(message, part.span, part.path, related=described(graph, others))


def _leaders(description: Description, joint: Joint) -> list[str]:
    followed: list[str] = []
    leader: Joint | None = joint
    while leader is not None and leader.mimic is not None and leader.mimic.joint not in followed:
        followed.append(leader.mimic.joint)
        leader = description.joint(leader.mimic.joint)
    return followed
