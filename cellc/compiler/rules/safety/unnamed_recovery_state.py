"""A state that stops the robot has no recovery.

Recovery from an unnamed state is a restart without a procedure.

Example that is reported:

```yaml
safety: {recovery: {states: [emergency_stop]}}  # expect at states
```

Example that is accepted:

```yaml
safety: {recovery: {states: [protective_stop, emergency_stop, fault]}}
```

Fix: name the states, and write down what is done in each.

Source: docs/principles.md#recovery
"""

from __future__ import annotations

from cellc.compiler.cell.site import STOPPED
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_EVERYWHERE = "emergency_stop"


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the states that are missing, in one finding; what no device has that states its own is not asked for."""
    states = graph.cell.safety.recovery.states
    known = {state.name for device in graph.cell.devices for state in device.safety.states}
    asked = [state for state in STOPPED if state in known or not known or state == _EVERYWHERE]
    missing = [state for state in asked if state not in states]
    if missing:
        names = ", ".join(f"`{state}`" for state in missing)
        yield found(graph, ("safety", "recovery", "states"), f"no recovery is named for {names}", f"add {names}")
