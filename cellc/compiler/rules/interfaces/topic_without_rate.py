"""A topic that feeds motion has no rate.

Without a rate a slow publisher looks like a dead one, and an age limit cannot be sized.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}},  # expect at /markers
             frame: world,
             wants: newest, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: add `rate:`, such as `10 Hz`.

Source: docs/principles.md#command-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.graph.data_flow import is_state_on_change
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics of the spec without a rate from which a way leads to a controller."""
    without = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.TOPIC and not interface.derived and interface.rate_hz is None
    ]
    feeding = graph.data.feeding_motion() if without else frozenset()
    for interface in without:
        if interface.name in feeding and not is_state_on_change(interface):
            way = graph.data.way_to_motion(interface)
            yield found(graph, interface.path, f"`{interface.name}` feeds motion ({way}) and has no `rate`")
