"""A collision shape names a mesh outside of the folders that belong to the cell.

A description may be untrusted, and `file:///home/me/part.stl`, `..` and links reach for what lies on this
machine: the check then depends on it, and no other computer finds the file. A mesh must lie in the folder of the spec
or in a package of `--package-path`; out of the folder of the spec no link may lead.

Example that is reported:

```xml
<link name="tool">
  <collision><geometry><mesh filename="file:///nowhere/tool.stl"/></geometry></collision>  <!-- expect -->
</link>
```

Example that is accepted:

```xml
<link name="tool">
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
```

Fix: put the file in a package beside the spec, and name it `package://PACKAGE/FILE`.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.rules.geometry import unusable_meshes
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield meshes that lie elsewhere."""
    yield from unusable_meshes(graph, "mesh-outside-root")
