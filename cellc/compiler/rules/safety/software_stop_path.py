"""The stop path runs through software.

A message may be late, lost or refused. A stop must work when everything that sends messages is dead.

Example that is reported:

```yaml
safety: {stop: {path: software}}  # expect at path
```

Example that is accepted:

```yaml
safety: {stop: {path: hardwired}}
```

Fix: write `hardwired` or `safety_bus`, and build it.

Source: docs/principles.md#stop
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a stop path of software."""
    if graph.cell.safety.stop.path == "software":
        message = "the stop must not reach the drives through software"
        yield found(graph, ("safety", "stop", "path"), message)
