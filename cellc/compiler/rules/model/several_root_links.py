"""A description has more than one root link.

What does not hang on the mounted root is in no tree: it has no pose in the cell, so it collides with nothing and
no lookup finds it. One public parser picks a root and is silent.

Example that is reported:

```xml
<link name="stray"/>  <!-- expect -->
```

Example that is accepted:

```xml
<link name="stray"/>
<joint name="stray_mount" type="fixed"><parent link="base"/> <child link="stray"/></joint>
```

Fix: connect the link with a joint, or delete it.

Source: https://wiki.ros.org/urdf/XML/robot (as of 2026-11-22): a robot is a tree of links with one root
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, rule


@rule(Severity.ERROR, assumes=("joint-of-unknown-link",))
def check(graph: CellGraph) -> Findings:
    """Yield every root but the one that is mounted."""
    for part in graph.model.links():
        root = part.device.root_link
        if part.link.name != root and part.link.name in part.device.description.roots():
            message = f"link `{part.link.name}` hangs on nothing; the root of `{part.device.name}` is `{root}`"
            mounted = part.device.description.link(root)
            related = (Related("the root", mounted.span),) if mounted is not None and mounted.span is not None else ()
            yield Finding(message, part.span, part.path, related=related)
