"""Motion is commanded over a bare topic.

A topic has no acceptance, no feedback, no result and no cancel. Whether the trajectory was taken, finished or dropped
shows in nothing but the arm.

Example that is reported:

```yaml
interfaces:
  /arm_trajectory/joint_trajectory: {topic: trajectory_msgs/msg/JointTrajectory, from: task,
                                     to: [arm_trajectory],  # expect at to.0
                                     wants: every_sample, rate: 1 Hz, max_age: 2 s, on_stale: ignore_sample,
                                     frame: world}
```

Example that is accepted:

```yaml
interfaces:
  /planned_trajectory: {topic: trajectory_msgs/msg/JointTrajectory, from: move_group, to: [task], frame: world,
                        wants: every_sample, rate: 1 Hz, max_age: 2 s, on_stale: ignore_sample}
```

Fix: send goals to the action of the controller.

Source: docs/principles.md#interaction-types
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield topics of the spec that end in a controller with command interfaces."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.kind is not InterfaceKind.TOPIC:
            continue
        for sink in interface.sinks:
            if sink.node in graph.data.commanders:
                message = f"controller `{sink.node}` is commanded over the topic `{interface.name}`"
                yield found(graph, sink.path, message)
