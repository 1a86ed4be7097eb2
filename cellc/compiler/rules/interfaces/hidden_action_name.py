"""An interface takes a name inside an action.

Below `/_action/` live the five entities of an action server. A topic of that name mixes with them, and a client that
talks to one of them bypasses the goal states.

Example that is reported:

```yaml
interfaces:
  /move_action/_action/feedback:  # expect at /move_action/_action/feedback
             {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: declare the action itself, and use it as an action.

Source: https://design.ros2.org/articles/actions.html (as of 2026-11-22): topics and services of an action
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield names with the part `_action`."""
    for interface in graph.cell.interfaces:
        if "_action" in interface.name.split("/"):
            message = f"`{interface.name}` is a hidden name of an action"
            yield found(graph, interface.path, message)
