"""A topic that feeds motion has no rate.

Without a rate nobody can tell a slow publisher from a dead one, nor size an age limit.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: write `rate:`.

Source: chapter 4, section 12: for every command path state frame, unit, rate, time source.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.interface import InterfaceKind
from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield topics of the spec without a rate from which a way leads to a controller."""
    without = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.TOPIC and not interface.derived and interface.rate_hz is None
    ]
    feeding = graph.data.feeding_motion() if without else frozenset()
    for interface in without:
        if interface.name in feeding:
            way = graph.data.way_to_motion(interface)
            yield found(
                graph, interface.path, f"`{interface.name}` feeds motion, {way}, and has no `rate`", "add `rate:`"
            )


RULE = define("topic-without-rate", Severity.ERROR, check, __doc__)
