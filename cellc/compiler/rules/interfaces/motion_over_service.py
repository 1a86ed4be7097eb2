"""Motion is requested over a service.

A service answers once. It shows no progress, cannot be canceled, and after a timeout does not say how far the arm
moved.

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

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

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


_SPEAKS_OF_NOTHING = ("std_srvs/srv/Trigger", "std_srvs/srv/SetBool", "std_srvs/srv/Empty")
"""Types whose meaning is in the name of the service."""
_ONLY_IN_NAMES = frozenset(["Go", "Goto", "Park", "Retract", "Approach", "Insert"])


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield services whose type speaks of motion and does not merely read, plan or set.

    A type that says nothing is judged by the name of the service, where its server commands a controller.
    """
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.SERVICE or interface.derived:
            continue
        words, motion = re.findall(r"[A-Z][a-z]+", interface.type.rpartition("/")[2]), _MOTION
        if interface.type in _SPEAKS_OF_NOTHING and any(_commands(graph, end.node) for end in interface.sources):
            name = interface.name.rpartition("/")[2]
            words, motion = [word.title() for word in re.findall(r"[A-Za-z][a-z]*", name)], _MOTION | _ONLY_IN_NAMES
        if words and words[0] not in _READING and not motion.isdisjoint(words):
            message = f"`{interface.name}` requests motion over the service `{interface.type}`"
            yield found(graph, (*interface.path, "service"), message)


def _commands(graph: CellGraph, node: str) -> bool:
    """Tell whether a node itself is the client of a controller."""
    return any(controller.client == node for controller in graph.cell.controllers)
