"""Motion goes on after a stop without a person.

What triggered the stop may still be there, and somebody may be in the cell to look at it.

Example that is reported:

```yaml
safety: {recovery: {acknowledge: automatic}}
```

Example that is accepted:

```yaml
safety: {recovery: {acknowledge: operator}}
```

Fix: let an operator acknowledge.

Source: chapter 4, section 6: whether operator acknowledgment is required; recovery needs named states.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield a recovery that acknowledges itself."""
    if graph.cell.spec.safety.recovery.acknowledge == "automatic":
        path = ("safety", "recovery", "acknowledge")
        yield found(graph, path, "recovery goes on without a person", "write `acknowledge: operator`")


RULE = define("automatic-recovery", Severity.ERROR, check, __doc__)
