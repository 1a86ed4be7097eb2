"""A sample may be older than the goal that uses it may last.

The watchdog of the goal ends before a stale sample is noticed, so staleness is never the reason that anybody sees.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 60 s, on_stale: reject_goal}  # expect at max_age
# expect: short-transform-buffer at frames.object.buffer
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: lower `max_age` below the timeout of the action that rests on it.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics that may be older than the timeout of an action that their subscriber calls."""
    actions = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.ACTION and interface.timeout_s
    ]
    for topic in graph.cell.interfaces:
        if topic.max_age_s is None:
            continue
        readers = {sink.node for sink in topic.sinks}
        for action in actions:
            if readers.isdisjoint(sink.node for sink in action.sinks) or topic.max_age_s <= (action.timeout_s or 0.0):
                continue
            message = (
                f"`max_age` of `{topic.name}` must be at most {action.timeout_s:g} s, the timeout of `{action.name}`, "
                f"got {topic.max_age_s:g} s"
            )
            related = (Related("the goal is bounded here", graph.cell.locate(*action.path, "timeout")),)
            yield found(graph, (*topic.path, "max_age"), message, related=related)
            break
