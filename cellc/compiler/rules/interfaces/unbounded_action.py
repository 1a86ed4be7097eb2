"""An action has no bound on a whole goal.

A goal that never ends blocks the next one, and a task that waits for it looks as if it were working.

Example that is reported:

```yaml
interfaces:
  /dock: {action: moveit_msgs/action/MoveGroup, server: dock, client: task, frame: world,  # expect at /dock
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

Fix: add `timeout:` with the longest time that a goal may take, such as `20 s`.

Source: docs/principles.md#interaction-types
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield actions of the spec without a timeout."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and not interface.derived and interface.timeout_s is None:
            message = f"action `{interface.name}` has no bound on a whole goal"
            yield found(graph, interface.path, message)
