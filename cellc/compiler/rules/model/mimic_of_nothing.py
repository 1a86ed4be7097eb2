"""A joint mimics a joint that does not exist.

Nothing moves the joint. URDF libraries drop the mimic or treat the joint as free, so the finger that should follow
stays open in one program and hangs loose in another.

Example that is reported:

```xml
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="0 0 1"/>
  <limit lower="0" upper="0.5" velocity="1" effort="10"/>
  <mimic joint="turnn"/>
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

Fix: name a joint of the same description.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): element mimic
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, did_you_mean, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield mimic joints whose leader is missing."""
    for part in graph.model.joints():
        mimic = part.joint.mimic
        description = part.device.description
        if mimic is not None and description.joint(mimic.joint) is None:
            message = f"joint `{part.joint.name}` mimics `{mimic.joint}`, which is not a joint of `{part.device.name}`"
            names = (joint.name for joint in description.joints)
            yield Finding(message, part.span, part.path, did_you_mean(mimic.joint, names, "joints"))
