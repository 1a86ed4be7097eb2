"""A service has no bound on its response time.

If the server dies, the caller waits forever: DDS does not report that an answer will not arrive.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, on_timeout: error,  # expect at /inspect
             on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: add `timeout:` with the longest time that an answer may take, such as `1 s`.

Source: docs/principles.md#interaction-types
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield services of the spec without a timeout."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.SERVICE and not interface.derived and interface.timeout_s is None:
            message = f"service `{interface.name}` has no bound on its response time"
            yield found(graph, interface.path, message)
