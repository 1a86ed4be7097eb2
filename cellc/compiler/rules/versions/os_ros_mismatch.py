"""The ROS distribution is not built for the operating system.

Packages of a distribution are built for one release of the operating system. On another they do not install, or run
against other libraries than they were tested with.

Example that is reported:

```yaml
versions: {os: ubuntu 26.04}  # expect at os
```

Example that is accepted:

```yaml
versions: {os: ubuntu 24.04}
```

Fix: install the release that the distribution is built for, or choose another distribution.

Source: https://www.ros.org/reps/rep-2000.html (as of 2025-10-24): target platforms
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.graph.versions import distribution
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield an operating system that the distribution is not built for."""
    facts = distribution(graph.cell)
    system = graph.cell.versions.os
    if facts is None or system == UNKNOWN:
        return
    written = system.lower()
    if not any(written == built or written.startswith(f"{built}.") for built in (*facts.os, *facts.os_tier3)):
        built_for = ", ".join(f"`{name}`" for name in facts.os)
        message = f"`{graph.cell.distro}` is built for {built_for}, not for `{system}`"
        yield found(graph, ("versions", "os"), message, f"install {built_for}, or choose another distribution")
