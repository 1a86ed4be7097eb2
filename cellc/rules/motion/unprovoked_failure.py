"""A rehearsal expects a failure that nothing provokes.

Without an injected fault the run succeeds, or it fails for a reason that nobody intended.

Example that is reported:

```yaml
rehearsals:
  odd: {steps: [move: home], expect: stale_state}  # expect at expect
```

Example that is accepted:

```yaml
rehearsals:
  odd: {steps: [move: home, detect: object, move: pick], inject: {freeze: camera, at: 1 s}, expect: stale_state}
```

Fix: add `inject:` with the fault that leads to the expected outcome.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield rehearsals that expect a failure and inject nothing."""
    for rehearsal in graph.cell.rehearsals:
        if rehearsal.expect != "succeeded" and not rehearsal.faults:
            message = f"`{rehearsal.name}` expects `{rehearsal.expect}`, but nothing provokes it"
            yield found(graph, (*rehearsal.path, "expect"), message)
