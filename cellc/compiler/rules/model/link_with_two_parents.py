"""A link is the child of two joints.

A URDF is a tree. With two parents the link has two poses, and which one a library takes depends on the order of the
file.

Example that is reported:

```xml
<joint name="slide" type="fixed"><parent link="arm"/> <child link="carriage"/></joint>
<joint name="bridge" type="fixed"><parent link="base"/> <child link="carriage"/></joint>  <!-- expect -->
```

Example that is accepted:

```xml
<joint name="slide" type="fixed"><parent link="arm"/> <child link="carriage"/></joint>
```

Fix: delete one of the two joints; a closed chain is modeled by a mimic joint.

Source: https://wiki.ros.org/urdf/XML/robot (as of 2026-11-22): a robot is a tree of links
"""

from __future__ import annotations

from cellc.compiler.graph.frame_tree import ModelJoint
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, rule


@rule(Severity.ERROR, assumes=("duplicate-model-name",))
def check(graph: CellGraph) -> Findings:
    """Yield the second joint that ends in one link."""
    seen: dict[tuple[str, str], ModelJoint] = {}
    for part in graph.model.joints():
        first = seen.setdefault((part.device.name, part.joint.child), part)
        if first is not part:
            message = f"link `{part.joint.child}` is the child of joints `{first.joint.name}` and `{part.joint.name}`"
            related = (Related(f"already the child of `{first.joint.name}`", first.span),)
            yield Finding(message, part.span, part.path, related=related)
