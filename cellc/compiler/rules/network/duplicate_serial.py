"""Two devices of one model have one serial number.

A serial number belongs to one unit. A block that was copied makes both drivers open the same unit, and the pictures of
one camera are taken for those of the other.

Example that is reported:

```yaml
# a cell of two cameras
devices:
  second: {serial: D4-0712}  # expect at serial
```

Example that is accepted:

```yaml
# a cell of two cameras
devices:
  second: {serial: D4-0757}
```

Fix: read the serial number from each device.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second device of one model with a serial number."""
    first: dict[tuple[str, str], Device] = {}
    for device in graph.cell.devices:
        serial = device.versions.serial
        if serial == UNKNOWN:
            continue
        owner = first.setdefault((device.model, serial), device)
        if owner is not device:
            message = f"`{device.name}` must have a serial number of its own, got `{serial}`, that of `{owner.name}`"
            related = (Related("first written here", graph.cell.locate(*owner.path, "serial")),)
            yield found(graph, (*device.path, "serial"), message, related=related)
