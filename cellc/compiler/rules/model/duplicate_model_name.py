"""Two links or two joints of a description have the same name.

A lookup returns the first or the last, depending on the library; TF then shows one of two bodies.

Example that is reported:

```xml
<joint name="slide" type="fixed"><parent link="base"/> <child link="carriage"/></joint>
<joint name="slide" type="fixed"><parent link="arm"/> <child link="probe"/></joint>  <!-- expect -->
<link name="probe"/>
```

Example that is accepted:

```xml
<joint name="slide" type="fixed"><parent link="base"/> <child link="carriage"/></joint>
<joint name="probe_mount" type="fixed"><parent link="arm"/> <child link="probe"/></joint>
<link name="probe"/>
```

Fix: rename one of the two.

Source: https://wiki.ros.org/urdf/XML/robot (as of 2026-11-22): names of links and of joints are unique
"""

from __future__ import annotations

from cellc.compiler.graph.frame_tree import ModelJoint, ModelLink
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second and every later bearer of a name."""
    seen: dict[tuple[str, str, str], ModelLink | ModelJoint] = {}
    named: list[tuple[str, str, ModelLink | ModelJoint]] = []
    named += [("link", link.link.name, link) for link in graph.model.links()]
    named += [("joint", joint.joint.name, joint) for joint in graph.model.joints()]
    for kind, name, part in named:
        first = seen.setdefault((part.device.name, kind, name), part)
        if first is not part:
            message = f"`{part.device.name}` has two {kind}s named `{name}`"
            related = (Related(f"first {kind} `{name}` here", first.span),)
            yield Finding(message, part.span, part.path, related=related)
