"""An action does not say how soon a cancel takes effect.

Cancel is a request. How long the arm may go on after it must be known before anybody relies on it.

Example that is reported:

```yaml
interfaces:
  /dock: {action: moveit_msgs/action/MoveGroup, server: dock, client: task, frame: world,  # expect at /dock
          timeout: 20 s,
          on_timeout: cancel_and_hold}
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

Fix: add `cancel_within:` with the longest time from cancel to hold, such as `200 ms`.

Source: docs/principles.md#interaction-types
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield actions of the spec without a bound from cancel to hold."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and not interface.derived and interface.cancel_within_s is None:
            message = f"action `{interface.name}` does not say how soon a cancel takes effect"
            yield found(graph, interface.path, message)
