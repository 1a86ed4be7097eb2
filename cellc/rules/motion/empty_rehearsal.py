"""A rehearsal has no steps.

It succeeds without doing anything, and counts as evidence.

Example that is reported:

```yaml
rehearsals:
  nothing: {steps: []}
```

Example that is accepted:

```yaml
rehearsals:
  something: {steps: [move: home]}
```

Fix: write `steps:`, or `use:` those of another rehearsal.

Source: chapter 4, section 11, gate G2.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield rehearsals without steps."""
    for rehearsal in graph.cell.rehearsals:
        if not rehearsal.steps:
            yield found(graph, rehearsal.path, f"rehearsal `{rehearsal.name}` does nothing", "write `steps:` or `use:`")


RULE = define("empty-rehearsal", Severity.ERROR, check, __doc__)
