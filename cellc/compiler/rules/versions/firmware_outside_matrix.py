"""A firmware does not fit the vendor's matrix.

The driver speaks a protocol that this firmware does not have, or has no longer. It connects and fails in a mode that
is untested.

Example that is reported:

```yaml
devices: {arm: {firmware: controller 4.2.0}}  # expect at firmware
```

Example that is accepted:

```yaml
devices: {arm: {firmware: controller 5.21.0}}
```

Fix: update the firmware, or pin the driver and SDK that support it.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.pins import version_numbers


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield firmware below the minimum or beyond the range of the rows for its product."""
    for device in graph.cell.devices:
        text = device.versions.firmware
        rows = [row for row in device.version_rows if row.part == "firmware" and row.product == text.split()[0]]
        numbers = version_numbers(text)
        for row in rows if numbers else ():
            minimum, below = version_numbers(row.minimum or ""), version_numbers(row.below or "")
            if (minimum and numbers < minimum) or (below and numbers >= below):
                bounds = (row.minimum and f"at least {row.minimum}", row.below and f"below {row.below}")
                allowed = f"{' and '.join(bound for bound in bounds if bound)} ({row.as_of})"
                message = f"the firmware of `{device.name}` must be {allowed}, got `{text}`"
                yield found(graph, (*device.path, "firmware"), message, row.note or "update the firmware")
