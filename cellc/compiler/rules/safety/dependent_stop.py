"""The stop is not declared independent of a host.

If the path of the stop needs a computer of the cell, it fails together with what it should stop.

Example that is reported:

```yaml
safety: {stop: {independent_of: []}}  # expect at independent_of
```

Example that is accepted:

```yaml
safety: {stop: {independent_of: [control_pc]}}
```

Fix: test the stop with the host switched off, and then list the host.

Source: docs/principles.md#stop
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield hosts that a known stop path may need."""
    stop = graph.cell.safety.stop
    if stop.path == UNKNOWN and stop.authority == UNKNOWN:
        return  # nothing is known yet, which is reported as such
    needed = [host for host in graph.cell.hosts if host not in stop.independent_of]
    if needed:
        names = " and ".join(f"`{host}`" for host in needed)
        path = ("safety", "stop", "independent_of")
        yield found(graph, path, f"the stop is not declared independent of {names}")
