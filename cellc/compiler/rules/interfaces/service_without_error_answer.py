"""A service does not say how it reports an error.

A caller that cannot tell refusal from success goes on in both cases.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s,  # expect at /inspect
             on_timeout: error}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: add `on_error:` with the field of the response that tells it.

Source: docs/principles.md#interaction-types
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield services of the spec without a stated error answer."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.SERVICE and not interface.derived and interface.on_error is None:
            message = f"service `{interface.name}` does not say how it reports an error"
            yield found(graph, interface.path, message)
