"""A sensor has its own clock and no bound to the host's.

Two clocks drift apart by seconds a day. Age limits and transform lookups then compare times that have nothing to do
with each other.

Example that is reported:

```yaml
devices:
  camera: {stamp: {source: hardware, clock: camera, synchronised_by: null, max_offset: null}}  # expect at stamp
```

Example that is accepted:

```yaml
devices:
  camera: {stamp: {source: hardware, clock: camera, synchronised_by: global_time, max_offset: 2 ms}}
```

Fix: write `synchronised_by`, what ties the clock to the host's, and `max_offset`, how far they may be apart.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield stamps of a clock of their own without synchronization or without a bound."""
    host_domains = {host.clock.domain for host in graph.cell.hosts.values()} or {"ros"}
    for device in graph.cell.devices:
        stamp = device.stamp
        if stamp is None or stamp.source != "hardware" or stamp.clock.domain in (UNKNOWN, *host_domains):
            continue
        if stamp.clock.synchronised_by is None or stamp.clock.max_offset_s is None:
            field = "synchronised_by" if stamp.clock.synchronised_by is None else "max_offset"
            message = f"clock `{stamp.clock.domain}` of `{device.name}` does not state `{field}`"
            path = (*device.path, "stamp", field)
            yield found(graph, path, message)
