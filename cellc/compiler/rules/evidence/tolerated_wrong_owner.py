"""The cell tolerates commands of a wrong owner or stale state.

One command of a wrong owner is one too many, and a stale sample that is used is motion without sight.

Example that is reported:

```yaml
kpis: {wrong_owner_events: 3}  # expect at wrong_owner_events
```

Example that is accepted:

```yaml
kpis: {wrong_owner_events: 0}
```

Fix: write 0 for wrong owners, and 100 % for the rejection of stale state.

Source: docs/principles.md#key-figures
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a target above zero wrong owners, and below all stale samples rejected."""
    kpis = graph.cell.kpis
    if kpis.wrong_owner_events:
        message = f"`wrong_owner_events` must be 0, got {kpis.wrong_owner_events}"
        yield found(graph, ("kpis", "wrong_owner_events"), message, "write 0")
    if kpis.stale_state_rejection is not None and kpis.stale_state_rejection < 1.0:
        path = ("kpis", "stale_state_rejection")
        message = f"`stale_state_rejection` must be 100 %, got {graph.cell.text(*path)}"
        yield found(graph, path, message, "write 100 %")
