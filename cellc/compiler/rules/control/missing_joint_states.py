"""No controller publishes the joint states.

Without them there is no TF of the moving links and no start state for a plan. Every node looks healthy.

Example that is reported:

```yaml
control:
  controllers:  # expect at controllers
    joint_states: null
```

Example that is accepted:

```yaml
control:
  controllers:
    joint_states: {type: joint_state_broadcaster}
```

Fix: add `joint_states: {type: joint_state_broadcaster}`.

Source: docs/principles.md#planning-and-execution
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import Behaviour


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield managers that drive joints without an active joint state broadcaster."""
    for manager in graph.cell.managers:
        publishing = any(c.behaviour is Behaviour.JOINT_STATE_BROADCASTER and c.active for c in manager.controllers)
        if not publishing and any(c.command_interfaces and c.joints for c in manager.controllers):
            path = (*manager.path, "controllers")
            message = f"no controller of `{manager.name}` publishes joint states"
            yield found(graph, path, message)
