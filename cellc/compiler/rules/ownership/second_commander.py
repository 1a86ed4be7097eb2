"""An action that moves something has two commanders.

The goal of one replaces or rejects the goal of the other. Both nodes are right on their own, and the arm does half of
each.

Example that is reported:

```yaml
interfaces:
  /arm_trajectory/follow_joint_trajectory:
    action: control_msgs/action/FollowJointTrajectory
    server: arm_trajectory
    client: [move_group, task]  # expect at client.1
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

Fix: send all goals through one node.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each further client of an action that ends in a controller."""
    declared = {c.action: c.client for c in graph.cell.controllers if c.action and c.client}
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.ACTION or interface.derived:
            continue
        owner = declared.get(interface.name) or next((sink.node for sink in interface.sinks), "")
        for sink in interface.sinks:
            if sink.node != owner:
                message = f"`{sink.node}` sends goals to `{interface.name}`, which `{owner}` commands"
                yield found(graph, sink.path, message, f"send the goals through `{owner}`")
