"""A group plans for joints that its controllers do not move.

The trajectory names a joint that the controller does not have, and the goal is rejected. The name of the controller
in the list proves nothing about its joints.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {joints: [arm/joint_1, arm/joint_2, arm/joint_3]}  # expect at joints
```

Example that is accepted:

```yaml
motion:
  groups:
    arm_only: {base: arm/base_link, tip: arm/tool0}
```

Fix: give the controller all joints of the group, or shorten the group.

Source: docs/principles.md#claims-and-switches
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("wrong-joint-count",))
def check(graph: CellGraph) -> Findings:
    """Yield groups with joints that are in none of their controllers."""
    for group in graph.cell.groups:
        controllers = [c for c in graph.cell.controllers if c.label in group.controllers]
        moved = {joint for controller in controllers for joint in controller.joints}
        missing = [joint for joint in group.joints if joint not in moved]
        if controllers and missing:
            names = ", ".join(f"`{joint}`" for joint in missing)
            message = f"group `{group.name}` plans for {names}, which `{controllers[0].name}` does not move"
            related = (Related("the group is here", group.span),)
            path = (*controllers[0].path, "joints")
            yield found(graph, path, message, related=related)
