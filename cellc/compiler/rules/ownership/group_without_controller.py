"""No controller executes what is planned for a group.

Planning succeeds and execution fails: there is no action server for the joints.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: null
    arm_forward: {type: forward_command, device: arm, client: move_group, parameters: {interface_name: position}}
# expect at motion.groups.manipulator
```

Example that is accepted:

```yaml
motion:
  groups:
    arm_only: {base: arm/base_link, tip: arm/tool0}
```

Fix: add a trajectory controller for the joints of the group, or the FollowJointTrajectory action of its adapter.

Source: docs/principles.md#planning-and-execution
"""

from __future__ import annotations

from cellc.compiler.graph.claims import adapter_of_group
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("wrong-joint-count",))
def check(graph: CellGraph) -> Findings:
    """Yield groups whose joints neither a controller nor an adapter with an action moves."""
    for group in graph.cell.groups:
        if group.joints and not group.controllers and adapter_of_group(graph.cell, group) is None:
            message = f"no controller takes trajectories for the joints of group `{group.name}`"
            yield found(graph, group.path, message)
