"""Motion continues although an answer is missing.

A server that does not answer may have died in the middle of a motion, or a clock has jumped. The caller must end in
a state that somebody can see.

Example that is reported:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s,
             on_timeout: continue,  # expect at on_timeout
             on_error: response.success is false}
```

Example that is accepted:

```yaml
interfaces:
  /inspect: {service: std_srvs/srv/Trigger, server: perception, client: task, timeout: 1 s, on_timeout: error,
             on_error: response.success is false}
```

Fix: write `cancel_and_hold` or `error`.

Source: docs/principles.md#failing-closed
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield services and actions whose timeout changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_timeout == "continue":
            message = f"the client of `{interface.name}` continues when no answer comes"
            yield found(graph, (*interface.path, "on_timeout"), message)
