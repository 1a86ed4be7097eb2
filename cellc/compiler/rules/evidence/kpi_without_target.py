"""A key figure has no target.

A figure without a target is looked at when it is good.

Example that is reported:

```yaml
kpis: {recovery_time: null}  # expect at kpis
```

Example that is accepted:

```yaml
kpis: {recovery_time: 120 s}
```

Fix: write the target.

Source: docs/principles.md#key-figures
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield the figures without a target in one finding."""
    missing = graph.cell.kpis.without_target()
    if missing:
        names = ", ".join(f"`{name}`" for name in missing)
        yield found(graph, ("kpis",), f"{names} {'have' if len(missing) > 1 else 'has'} no target")
