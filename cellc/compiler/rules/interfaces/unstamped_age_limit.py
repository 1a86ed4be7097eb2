"""The age of a sample is limited, but its type has no stamp.

Without a header the reader knows when a message was sent and when it arrived, which the middleware tells, but not when
its content was true. What was computed from an old image passes every test of age. It is asked of types that move the
robot or decide whether it moves.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/Pose, from: perception, to: {task: {depth: 1}}, frame: world,  # expect at topic
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: use the stamped variant of the type, or one of your own that begins with a header.

Source: docs/principles.md#transforms-at-the-time-of-observation
"""

from __future__ import annotations

from cellc.compiler.graph.data_flow import interface_types
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics that feed motion with an age limit and a type without header."""
    known = interface_types()
    for interface in graph.cell.interfaces:
        facts = known.get(interface.type)
        if interface.derived or interface.max_age_s is None or facts is None:
            continue
        if facts.feeds_motion and not facts.stamped:
            stamped = f"{interface.type}Stamped"
            advice = f"use `{stamped}`" if stamped in known else "use a type that begins with a header"
            message = f"`{interface.name}` limits the age of `{interface.type}`, which has no stamp"
            yield found(graph, (*interface.path, "topic"), message, advice)
