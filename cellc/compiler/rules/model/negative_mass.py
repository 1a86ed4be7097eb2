"""A link has a mass below zero.

Dynamics with a negative mass accelerate against the force. URDF libraries load it, and the error shows as an unstable
simulation or a gravity compensation that pushes down.

Example that is reported:

```xml
<link name="carriage">  <!-- expect -->
  <inertial><mass value="-1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
</link>
```

Example that is accepted:

```xml
<link name="carriage">
  <inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
</link>
```

Fix: write the mass in kg, or leave `<inertial>` out for a bare frame.

Source:

- https://wiki.ros.org/urdf/XML/link (as of 2026-11-22): element inertial
- https://www.ros.org/reps/rep-0103.html (as of 2025-10-24): mass is in kg
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield links that weigh less than nothing."""
    for part in graph.model.links():
        inertial = part.link.inertial
        if inertial is not None and inertial.mass < 0.0:
            message = f"the mass of link `{part.link.name}` must not be negative, got {inertial.mass:g} kg"
            yield Finding(message, part.span, part.path)
