"""A service or action does not say what happens when no answer comes.

A missing responder must end in a state that somebody can see, not in a caller that hangs.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s,  # expect at /inspect
             on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: add `on_timeout:`, `cancel_and_hold` for motion and `error` for a query.

Source: docs/principles.md#failing-closed
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield services and actions of the spec without a behavior on timeout."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC or interface.derived or interface.on_timeout is not None:
            continue
        message = f"{interface.kind.value} `{interface.name}` does not say what happens when no answer comes"
        yield found(graph, interface.path, message)
