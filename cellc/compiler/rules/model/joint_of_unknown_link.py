"""A joint connects a link that does not exist.

The tree breaks off there: everything behind the joint is lost to TF, to the planner and to collision checks.

Example that is reported:

```xml
<joint name="slide" type="fixed"><parent link="armm"/> <child link="carriage"/></joint>  <!-- expect -->
```

Example that is accepted:

```xml
<joint name="slide" type="fixed"><parent link="arm"/> <child link="carriage"/></joint>
```

Fix: name links of the same description.

Source: https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): elements parent and child
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, did_you_mean, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield joints whose parent or child is no link."""
    for part in graph.model.joints():
        description = part.device.description
        for role, name in (("parent", part.joint.parent), ("child", part.joint.child)):
            if description.link(name) is None:
                message = f"the {role} of joint `{part.joint.name}` is `{name}`, which is not a link"
                links = (link.name for link in description.links)
                yield Finding(message, part.span, part.path, did_you_mean(name, links, "links"))
