"""The meaning of a sensor's stamps is not stated.

A stamp set at exposure, at the driver's read and at arrival differ by the exposure, the buffers and the cable. Paired
with the joint states of another moment, the object moves although nothing did.

Example that is reported:

```yaml
devices:
  camera: {stamp: {source: UNKNOWN}}  # expect at source
```

Example that is accepted:

```yaml
devices:
  camera: {stamp: {source: hardware}}
```

Fix: read the driver's documentation, or measure with a moving target, and write source and clock of the stamp.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield cameras whose stamp source or clock domain is UNKNOWN or not stated."""
    for device in graph.cell.devices:
        if device.kind != "camera":
            continue
        stamp = device.stamp
        path = (*device.path, "stamp")
        if stamp is None or stamp.source == UNKNOWN:
            yield found(graph, (*path, "source"), f"the stamp source of `{device.name}` is UNKNOWN")
        elif stamp.clock.domain == UNKNOWN:
            yield found(graph, (*path, "clock"), f"the clock domain of `{device.name}` is UNKNOWN")
