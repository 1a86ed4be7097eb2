"""A controller that moves something has no declared commander.

The first node that finds the action commands the arm. Only a declared client can be checked, and only it gets
permission in the access policy.

Example that is reported:

```yaml
control:
  controllers:
    arm_trajectory: {client: null}  # expect at arm_trajectory
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_trajectory: {client: move_group}
```

Fix: add `client:` with the one node that may command it.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield controllers with command interfaces and without a client."""
    for controller in graph.cell.controllers:
        if controller.command_interfaces and controller.client is None:
            message = f"controller `{controller.name}` has no declared client"
            yield found(graph, controller.path, message)
