"""A node on the command path is restarted automatically.

A restarted commander may send its last goal again, unattended. Restarting perception is not the same
as restarting what moves.

Example that is reported:

```yaml
nodes:
  task: {respawn: true}  # expect at respawn
```

Example that is accepted:

```yaml
nodes:
  perception: {respawn: true}
```

Fix: remove `respawn`, and let an operator start the node again.

Source: docs/principles.md#restarts-and-reconnects
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield respawned nodes that send goals to a controller or to an action."""
    for node in graph.cell.nodes:
        if not node.respawn:
            continue
        commands = [
            c.action or c.name for c in graph.cell.controllers if c.client == node.name and c.command_interfaces
        ]
        commands += [
            interface.name
            for interface in graph.cell.interfaces
            if interface.kind is InterfaceKind.ACTION
            and any(e.node == node.name for e in (*interface.sinks, *interface.sources))
        ]
        if commands:
            message = f"`{node.name}` commands `{commands[0]}` and must not be restarted automatically"
            yield found(graph, (*node.path, "respawn"), message)
