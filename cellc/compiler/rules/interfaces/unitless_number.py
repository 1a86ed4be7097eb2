"""A topic carries bare numbers without a unit.

A Float64 is millimeters for its writer and meters for its reader, until the arm shows which. Types of std_msgs fix no
unit.

Example that is reported:

```yaml
interfaces:
  /part_height: {topic: std_msgs/msg/Float64, from: perception, to: {task: {depth: 1}},  # expect at /part_height
                 wants: newest, rate: 10 Hz,
                 max_age: 200 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
interfaces:
  /part_height: {topic: std_msgs/msg/Float64, from: perception, to: {task: {depth: 1}}, wants: newest, rate: 10 Hz,
                 max_age: 200 ms, on_stale: reject_goal, unit: m}
```

Fix: add `unit:`, such as `m`, or use a type that fixes it.

Source:

- https://www.ros.org/reps/rep-0103.html (as of 2025-10-24): units
- docs/principles.md#command-contracts
"""

from __future__ import annotations

import re

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_NUMBER = re.compile(r"std_msgs/msg/(Float|Int|UInt)(8|16|32|64)(MultiArray)?")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics of plain numbers without a unit."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.unit is None and _NUMBER.fullmatch(interface.type):
            message = f"`{interface.name}` carries bare numbers without a unit"
            yield found(graph, interface.path, message)
