"""A joint's lower limit lies above its upper limit.

No position satisfies such limits. URDF libraries load them without a word: planners then find no valid state, and a
controller that clamps to them jumps to one end.

Example that is reported:

```xml
<joint name="slide" type="prismatic">  <!-- expect -->
  <parent link="base"/> <child link="carriage"/> <axis xyz="1 0 0"/>
  <limit lower="0.5" upper="-0.5" velocity="1" effort="10"/>
</joint>
```

Example that is accepted:

```xml
<joint name="slide" type="prismatic">
  <parent link="base"/> <child link="carriage"/> <axis xyz="1 0 0"/>
  <limit lower="-0.5" upper="0.5" velocity="1" effort="10"/>
</joint>
```

Fix: swap `lower` and `upper` after checking on the real joint which way is positive.

Source:

- https://wiki.ros.org/urdf/XML/joint (as of 2026-11-22): element limit
- docs/principles.md#robot-descriptions
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Severity, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield joints without a single allowed position."""
    for part in graph.model.joints():
        limit = part.joint.limit
        if limit is None or limit.lower is None or limit.upper is None or limit.lower <= limit.upper:
            continue
        message = f"joint `{part.joint.name}` has lower limit {limit.lower:g} above upper limit {limit.upper:g}"
        yield Finding(message, part.span, part.path)
