"""Data that feeds motion has no age limit.

A frozen camera or a stalled node keeps its last message in the queue. Without a limit the arm drives to where the
part was, and everything looks healthy.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}},  # expect at /markers
             frame: world,
             wants: newest, rate: 10 Hz}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: add `max_age` and `on_stale`.

Source: docs/principles.md#failing-closed
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.graph.data_flow import is_state_on_change
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics without an age limit from which a way leads to a controller."""
    unlimited = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.TOPIC and not interface.derived and interface.max_age_s is None
    ]
    feeding = graph.data.feeding_motion() if unlimited else frozenset()
    for interface in unlimited:
        if interface.name in feeding and not is_state_on_change(interface):
            way = graph.data.way_to_motion(interface)
            message = f"`{interface.name}` feeds motion ({way}) and has no `max_age`"
            yield found(graph, interface.path, message)
