"""Motion resumes after a stop without a person.

What triggered the stop may still be there, and somebody may be in the cell to look at it.

Example that is reported:

```yaml
safety: {recovery: {acknowledge: automatic}}  # expect at acknowledge
```

Example that is accepted:

```yaml
safety: {recovery: {acknowledge: operator}}
```

Fix: write `acknowledge: operator`.

Source: docs/principles.md#restarts-and-reconnects
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a recovery that acknowledges itself."""
    if graph.cell.safety.recovery.acknowledge == "automatic":
        path = ("safety", "recovery", "acknowledge")
        yield found(graph, path, "recovery continues without a person")
