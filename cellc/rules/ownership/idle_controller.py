"""A controller is never active.

It is loaded, configured and listed, and no declared switch activates it. Somebody will force it one day.

Example that is reported:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  parameters: {interface_name: position}}
```

Example that is accepted:

```yaml
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: task, active: false,
                  parameters: {interface_name: position}}
  switches:
    to_forward: {activate: [arm_forward], deactivate: [arm_trajectory]}
```

Fix: declare the switch that activates it, or delete it.

Source: chapter 4, section 7: a listed controller name does not prove that it controls anything.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield controllers that are active in no reachable state."""
    for manager in graph.cell.managers:
        active = graph.claims.ever_active(manager.name)
        for controller in manager.controllers:
            if controller.name not in active:
                message = f"controller `{controller.name}` starts inactive and no switch activates it"
                yield found(graph, controller.path, message, "declare the switch, or delete the controller")


RULE = define(
    "idle-controller",
    Severity.WARNING,
    check,
    __doc__,
    assumes=("double-claim", "double-claim-after-switch", "impossible-switch"),
)
