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

from cellc.pins import version_numbers
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parts whose major version is that of a row of another distribution and of none of this one."""
    for device in graph.cell.devices:
        for part in ("driver", "sdk", "description"):
            text = device.versions.part(part)
            rows = [row for row in device.version_rows if row.part == part and row.known]
            ours = version_numbers(text)[:1]
            here = {
                version_numbers(known)[:1]
                for row in rows
                if row.distro in (None, graph.cell.distro)
                for known in row.known
            }
            others = {row.distro for row in rows for known in row.known if version_numbers(known)[:1] == ours}
            if ours and here and ours not in here and others:
                names = " and ".join(sorted(name for name in others if name is not None))
                message = f"`{text}` of `{device.name}` is of {names}, the cell runs {graph.cell.distro}"
                yield found(graph, (*device.path, part), message, f"pin the line of {graph.cell.distro}")
