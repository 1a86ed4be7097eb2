"""A collision shape names a mesh that is too large to be checked with.

A mesh of a million triangles takes minutes to plan with and a gigabyte of memory, in `move_group` too, and a hostile
one takes a machine down. Vendors ship meshes of some hundred to some ten thousand triangles for collisions beside the
fine ones to look at. Bounded are bytes, triangles, shapes and the time of reading; docs/limits.md has the figures.

Example that is reported:

```xml
<link name="tool">
  <collision><geometry><mesh filename="package://stage/meshes/million.stl"/></geometry></collision>  <!-- expect -->
</link>
```

Example that is accepted:

```xml
<link name="tool">
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
```

Fix: name a coarser mesh in `<collision>`, and leave the fine one to `<visual>`.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.rules.geometry import unusable_meshes
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield meshes beyond the limits."""
    yield from unusable_meshes(graph, "mesh-too-large")
