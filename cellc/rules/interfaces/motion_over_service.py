"""Motion is requested over a service.

A service answers once. Nobody sees progress, nobody can cancel, and after a timeout nobody knows how far the arm
went.

Example that is reported:

```yaml
interfaces:
  /move_to_bin: {service: cell_msgs/srv/MoveToPose, server: move_group, client: task,  # expect at service
                 timeout: 20 s,
                 on_timeout: error, on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /plan_to_bin: {service: moveit_msgs/srv/GetMotionPlan, server: move_group, client: task, timeout: 5 s,
                 on_timeout: error, on_error: response.error_code}
```

Fix: declare an action, with feedback, cancel and result; a service may plan or read.

Source: docs/principles.md#interaction-types
"""

from __future__ import annotations

import re

from cellc.cell.interface import InterfaceKind
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule

_MOTION = frozenset(
    [
        "Move",
        "Motion",
        "Execute",
        "Trajectory",
        "Grip",
        "Grasp",
        "Pick",
        "Place",
        "Follow",
        "Servo",
        "Jog",
        "Home",
        "Dock",
    ]
)
_READING = ("Get", "Check", "Query", "Plan", "List", "Compute", "Set")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield services whose type speaks of motion and does not merely read, plan or set."""
    for interface in graph.cell.interfaces:
        words = re.findall(r"[A-Z][a-z]+", interface.type.rpartition("/")[2])
        if interface.kind is not InterfaceKind.SERVICE or not words or words[0] in _READING:
            continue
        if not _MOTION.isdisjoint(words):
            message = f"`{interface.name}` requests motion over the service `{interface.type}`"
            yield found(graph, (*interface.path, "service"), message)
