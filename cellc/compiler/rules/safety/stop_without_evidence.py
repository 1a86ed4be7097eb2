"""Nothing proves that the stop works.

A stop that was never pressed is an assumption.

Example that is reported:

```yaml
safety: {stop: {evidence: []}}  # expect at evidence
```

Example that is accepted:

```yaml
safety: {stop: {evidence: [injected-stop result]}}
```

Fix: inject a stop, keep the result, and name it under `evidence`.

Source: docs/principles.md#stop
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield a stated stop without evidence."""
    stop = graph.cell.safety.stop
    if stop.authority != UNKNOWN and not stop.evidence:
        path = ("safety", "stop", "evidence")
        yield found(graph, path, f"nothing proves the stop of `{stop.authority}`")
