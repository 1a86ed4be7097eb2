"""A collision shape names a mesh that cannot be read.

The file has no triangles, coordinates that are not finite, lengths beyond 1000 km, a scale of 0, or it is not what
its name says. Libraries warn of such a file on stderr, drop the shape or check with the part that they understood,
and the link is then invisible to collision checking. Read are STL, COLLADA, OBJ, PLY, OFF and GLB that are one file,
by a process of its own with bounded time and memory; materials and images are not looked at.

Example that is reported:

```xml
<link name="tool">
  <collision><geometry><mesh filename="package://stage/meshes/broken.stl"/></geometry></collision>  <!-- expect -->
</link>
```

Example that is accepted:

```xml
<link name="tool">
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
```

Fix: open the mesh in a viewer, and export it again as one file of triangles, such as STL.

Source:

- https://wiki.ros.org/urdf/XML/link (as of 2026-11-22): collision geometry may be a mesh file with a scale
- https://github.com/assimp/assimp/blob/v6.0.2/doc/Fileformats.md (v6.0.2): formats that MoveIt and RViz read through it
"""

from __future__ import annotations

from cellc.compiler.rules.geometry import unusable_meshes
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield meshes that cannot be read."""
    yield from unusable_meshes(graph, "malformed-mesh")
