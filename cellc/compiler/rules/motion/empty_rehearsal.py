"""A rehearsal has no steps.

It succeeds without doing anything, and counts as evidence.

Example that is reported:

```yaml
rehearsals:
  nothing: {steps: []}  # expect at nothing
```

Example that is accepted:

```yaml
rehearsals:
  something: {steps: [move: home]}
```

Fix: write `steps:`, or `use:` those of another rehearsal.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield rehearsals without steps."""
    for rehearsal in graph.cell.rehearsals:
        if not rehearsal.steps:
            yield found(graph, rehearsal.path, f"rehearsal `{rehearsal.name}` does nothing")
