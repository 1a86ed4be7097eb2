"""A service or an action has no client.

A server without a declared client is open to any node: the wrong client may be the first.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: [], timeout: 1 s,  # expect at client
             on_timeout: error,
             on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: name the client, or delete the interface.

Source: docs/principles.md#one-commander
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield services and actions of the spec without a client."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.kind is not InterfaceKind.TOPIC and not interface.sinks:
            message = f"the {interface.kind.value} `{interface.name}` has no client"
            yield found(graph, (*interface.path, "client"), message)
