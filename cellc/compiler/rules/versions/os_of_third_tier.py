"""The distribution has no tested packages for the operating system.

On a platform of the third tier everything is built from source, and no tests run there. What works for the
planner's author says nothing about the vendor's driver.

Example that is reported:

```yaml
versions: {os: ubuntu 22.04}  # expect at os
```

Example that is accepted:

```yaml
versions: {os: ubuntu 24.04}
```

Fix: install the release that packages are made for, or keep the evidence of your own build and test.

Source: https://www.ros.org/reps/rep-2000.html (as of 2025-10-24): support tiers
"""

from __future__ import annotations

from cellc.compiler.graph.versions import distribution
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield an operating system of the third tier of the distribution."""
    facts = distribution(graph.cell)
    system = graph.cell.versions.os
    written = system.lower()
    if facts is not None and any(written == tier or written.startswith(f"{tier}.") for tier in facts.os_tier3):
        tested = ", ".join(f"`{name}`" for name in facts.os)
        message = f"`{graph.cell.distro}` has no tested packages for `{system}`, only for {tested}"
        yield found(graph, ("versions", "os"), message, f"install {tested}, or keep the evidence of your own build")
