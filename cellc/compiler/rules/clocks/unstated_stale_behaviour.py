"""An age limit has no consequence.

A limit without a reaction is a comment. What happens to an older sample must be decided before it arrives.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}},  # expect at /markers
             frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: add `on_stale:`, such as `reject_goal`, `stop_and_hold` or `ignore_sample`.

Source: docs/principles.md#failing-closed
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics with an age limit and nothing that follows from it."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.max_age_s is not None and interface.on_stale is None:
            message = f"`{interface.name}` has a `max_age` of {interface.max_age_s:g} s but no `on_stale`"
            yield found(graph, interface.path, message)
