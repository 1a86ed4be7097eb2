"""Motion continues with data that is too old.

To continue on a stale sample, or after a clock jump that makes every sample stale, is to move blindly. A timeout has
to fail closed.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: continue}  # expect at on_stale
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: stop_and_hold}
```

Fix: write `reject_goal`, `stop_and_hold` or `ignore_sample`.

Source: docs/principles.md#failing-closed
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics on which a stale sample changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_stale == "continue":
            message = f"`{interface.name}` is used even when it is stale"
            path = (*interface.path, "on_stale")
            yield found(graph, path, message)
