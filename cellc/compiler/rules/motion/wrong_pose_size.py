"""A named pose has too few or too many values.

Positions are bound to joints in the order of the chain. With another number every value after the gap belongs to
another joint.

Example that is reported:

```yaml
motion:
  poses: {home: {manipulator: 0 -90 90 -90 -90 deg}}  # expect at manipulator
```

Example that is accepted:

```yaml
motion:
  poses: {home: {manipulator: 0 -90 90 -90 -90 0 deg}}
```

Fix: write one value for each joint of the group, base first.

Source: docs/principles.md#planning-and-execution
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield poses whose number of values is not that of the group's joints."""
    for pose in graph.cell.poses:
        if len(pose.joints) != len(pose.positions):
            message = (
                f"expected {len(pose.joints)} values in pose `{pose.name}` of `{pose.group}`, got {len(pose.positions)}"
            )
            names = ", ".join(pose.joints)
            yield found(graph, pose.path, message, f"write one value for each of {names}")
