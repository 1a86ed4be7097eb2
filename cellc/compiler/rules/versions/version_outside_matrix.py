"""A driver, SDK or description belongs to another distribution.

Vendors release one line of their packages for each distribution. One from another line does not build, or pairs
interfaces that were never tested together.

Example that is reported:

```yaml
devices: {arm: {driver: demo_arm_driver 2.14.0}}  # expect at driver
```

Example that is accepted:

```yaml
devices: {arm: {driver: demo_arm_driver 3.8.0}}
```

Fix: pin the line of the cell's distribution.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.graph.releases import PACKAGED, foreign_lines
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parts whose major version is that of a row of another distribution and of no row or release of this one."""
    distro = graph.cell.distro
    for device in graph.cell.devices:
        for part in PACKAGED:
            others = {row.distro for row in foreign_lines(device, part, distro)}
            if others:
                names = " and ".join(sorted(name for name in others if name is not None))
                message = f"`{device.versions.part(part)}` of `{device.name}` is of {names}, the cell runs {distro}"
                yield found(graph, (*device.path, part), message, f"pin the line of {distro}")
