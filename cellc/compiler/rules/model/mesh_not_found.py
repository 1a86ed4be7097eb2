"""A collision shape names a mesh that is not there.

A link without its shape touches nothing: poses and goals are judged and the mock plans with the shapes that are there,
and collisions of the link go unseen. The mock names it with every run, and G1 is not passed. A mesh is looked for in
the folders of `--package-path`, then as a package in the folder of the spec and in those of its `packages:`. Shapes to
look at (`<visual>`) are not read.

Example that is reported:

```xml
<link name="tool">
  <collision><geometry><mesh filename="package://nowhere/tool.stl"/></geometry></collision>  <!-- expect -->
</link>
```

Example that is accepted:

```xml
<link name="tool">
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
```

Fix: name the folder of the package in `packages:` of the spec or with `--package-path`, or use boxes and cylinders.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.rules.geometry import unusable_meshes
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield meshes that are not there."""
    yield from unusable_meshes(graph, "mesh-not-found")
