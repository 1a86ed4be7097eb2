"""The distribution does not have this middleware.

A misspelled middleware is not loaded; the nodes end when they start, or one of them takes the default and never meets
the others.

Example that is reported:

```yaml
versions: {rmw: rmw_fastrtps 8.4.4}  # expect at rmw
```

Example that is accepted:

```yaml
versions: {rmw: rmw_fastrtps_cpp 8.4.4}
```

Fix: write the name of the package, as in RMW_IMPLEMENTATION, and its version.

Source:

- https://www.ros.org/reps/rep-2000.html (as of 2025-10-24): middleware
- docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.graph.versions import distribution
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a middleware that the distribution does not have."""
    facts = distribution(graph.cell)
    written = graph.cell.versions.rmw
    if facts is None or written == UNKNOWN:
        return
    known = (*facts.rmw, *facts.rmw_unverified)
    if written.split()[0] not in known:
        message = f"`{written.split()[0]}` is not a middleware of {graph.cell.distro}"
        yield found(graph, ("versions", "rmw"), message, did_you_mean(written.split()[0], known, "middlewares"))
