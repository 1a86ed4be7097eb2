"""A Cartesian command path names no frame.

Numbers without a frame are right in one node's base and wrong in the other's. The arm moves, and to the wrong side.

Example that is reported:

```yaml
interfaces:
  /dock: {action: moveit_msgs/action/MoveGroup, server: dock, client: task, timeout: 20 s,  # expect at /dock
          on_timeout: cancel_and_hold, cancel_within: 200 ms}
nodes:
  dock: {run: cell_tasks/dock, host: control_pc, owner: integration}
```

Example that is accepted:

```yaml
interfaces:
  /dock: {action: moveit_msgs/action/MoveGroup, server: dock, client: task, frame: world, timeout: 20 s,
          on_timeout: cancel_and_hold, cancel_within: 200 ms}
nodes:
  dock: {run: cell_tasks/dock, host: control_pc, owner: integration}
```

Fix: add `frame:` with the frame in which goals are given, such as `world`.

Source: docs/principles.md#command-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_WITHOUT_PLACE = frozenset({"control_msgs/action/GripperCommand", "control_msgs/action/ParallelGripperCommand"})
"""Actions whose goals are an opening and a force, in no frame."""


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield actions of the spec without a frame, apart from those whose goals have no place."""
    for interface in graph.cell.interfaces:
        if interface.type in _WITHOUT_PLACE:
            continue
        if interface.kind is InterfaceKind.ACTION and not interface.derived and interface.frame is None:
            message = f"action `{interface.name}` does not say in which frame its goals are"
            yield found(graph, interface.path, message)
