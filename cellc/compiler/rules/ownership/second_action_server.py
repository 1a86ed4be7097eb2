"""Two nodes serve one action.

A goal reaches both, each accepts it, and two controllers move. The client sees one answer.

Example that is reported:

```yaml
interfaces:
  /arm_trajectory/follow_joint_trajectory:
    action: control_msgs/action/FollowJointTrajectory
    server: task  # expect at server
    client: move_group
    frame: world
    timeout: 20 s
    on_timeout: cancel_and_hold
    cancel_within: 200 ms
```

Example that is accepted:

```yaml
interfaces:
  /arm_trajectory/follow_joint_trajectory:
    action: control_msgs/action/FollowJointTrajectory
    server: arm_trajectory
    client: move_group
    frame: world
    timeout: 20 s
    on_timeout: cancel_and_hold
    cancel_within: 200 ms
```

Fix: let the controller serve its own action, and give the other server another name.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield servers of an action that a controller serves itself."""
    owners = {controller.action: controller for controller in graph.cell.controllers if controller.action}
    for interface in graph.cell.interfaces:
        owner = owners.get(interface.name)
        for source in interface.sources:
            if owner is not None and source.full_name != owner.full_name:
                message = f"`{source.node}` serves `{interface.name}`, which controller `{owner.name}` serves itself"
                related = (Related("the controller is here", owner.span),)
                yield found(graph, source.path, message, related=related)
