"""Two nodes publish on one command topic.

The controller follows the latest message, so the arm jumps between two goals.

Example that is reported:

```yaml
interfaces:
  /arm_trajectory/joint_trajectory: {topic: trajectory_msgs/msg/JointTrajectory,
                                     from: [task, move_group],  # expect at from.1
                                     to: [arm_trajectory], wants: every_sample,  # expect: motion-over-topic at to.0
                                     rate: 1 Hz, max_age: 2 s,
                                     on_stale: ignore_sample, frame: world}
```

Example that is accepted:

```yaml
interfaces:
  /planned_trajectory: {topic: trajectory_msgs/msg/JointTrajectory, from: [task, move_group], to: [perception],
                        wants: every_sample, rate: 1 Hz, max_age: 2 s, on_stale: ignore_sample, frame: world}
```

Fix: let one node publish commands.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each further publisher of a topic that a controller follows."""
    for interface in graph.cell.interfaces:
        commanded = next((sink.node for sink in interface.sinks if sink.node in graph.data.commanders), None)
        if interface.kind is not InterfaceKind.TOPIC or commanded is None:
            continue
        for source in interface.sources[1:]:
            first = interface.sources[0]
            message = f"`{source.node}` and `{first.node}` both command `{commanded}` over `{interface.name}`"
            related = (Related("first commanded here", first.span),)
            yield found(graph, source.path, message, related=related)
