"""A joint mimics a joint that cannot move.

A fixed joint has no position to follow. Libraries differ: one holds the follower at its offset, one frees it, one
fails while the robot is running.

Example that is reported:

```xml
<joint name="flange" type="fixed"><parent link="arm"/> <child link="tool"/></joint>
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
  <mimic joint="flange"/>
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

Fix: name the joint that is driven, or make the follower fixed.

Source:

- https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): element mimic
- docs/principles.md#robot-descriptions
"""

from __future__ import annotations

from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, did_you_mean, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield mimic joints whose leader is fixed."""
    for part in graph.model.joints():
        mimic = part.joint.mimic
        leader = None if mimic is None else part.device.description.joint(mimic.joint)
        if leader is not None and not leader.movable:
            message = f"joint `{part.joint.name}` mimics `{leader.name}`, which is {leader.type}"
            movable = (joint.name for joint in part.device.description.joints if joint.movable)
            advice = did_you_mean(leader.name, movable, "moving joints")
            yield Finding(message, part.span, part.path, advice, described(graph, [leader.name]))
