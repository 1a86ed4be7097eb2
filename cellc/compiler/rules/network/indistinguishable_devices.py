"""Two devices of one model on one host cannot be distinguished.

Neither has an address, a port or a serial number, so that each driver opens the first unit that it finds. Which one
that is depends on the order in which the units started.

Example that is reported:

```yaml
# a cell of two cameras
devices:
  camera: {serial: null}  # expect at camera
  second: {serial: null}  # expect at second
```

Example that is accepted:

```yaml
# a cell of two cameras
devices:
  camera: {serial: D4-0712}
  second: {serial: D4-0756}
```

Fix: add `serial:`, which the driver then uses.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices without address, port and serial number that share their model and host with another."""
    alike: dict[tuple[str, str], list[Device]] = {}
    for device in graph.cell.devices:
        link = device.connection
        if link is not None and link.address is None and link.port is None:
            alike.setdefault((device.model, link.host), []).append(device)
    for (model, host), devices in alike.items():
        for device in devices if len(devices) > 1 else ():
            if device.versions.serial != UNKNOWN:
                continue
            others = [other for other in devices if other is not device]
            message = f"`{device.name}` must state its `serial`, as `{others[0].name}` on `{host}` is a `{model}` too"
            related = tuple(Related("of the same model", other.span) for other in others)
            yield found(graph, (*device.path, "serial"), message, related=related)
