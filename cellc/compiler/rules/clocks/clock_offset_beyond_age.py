"""The offset of a clock exceeds the age limit of its samples.

With such an offset a sample passes the age test although it is too old, or fails it although it is fresh.

Example that is reported:

```yaml
devices:
  camera: {stamp: {source: hardware, clock: camera, synchronised_by: global_time,
                   max_offset: 500 ms}}  # expect at max_offset
```

Example that is accepted:

```yaml
devices:
  camera: {stamp: {source: hardware, clock: camera, synchronised_by: global_time, max_offset: 2 ms}}
```

Fix: tighten the synchronization: the offset must be a small part of the age.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield sensors whose clock offset reaches the age limit of one of their topics."""
    for device in graph.cell.devices:
        stamp = device.stamp
        if stamp is None or stamp.clock.max_offset_s is None:
            continue
        limits = [
            interface
            for interface in graph.cell.interfaces
            if interface.max_age_s is not None and any(end.node == device.name for end in interface.sources)
        ]
        shortest = min(limits, key=lambda interface: interface.max_age_s or 0.0, default=None)
        if shortest is not None and stamp.clock.max_offset_s >= (shortest.max_age_s or 0.0):
            path = (*device.path, "stamp", "max_offset")
            offset = graph.cell.text(*path)
            age = f"{(shortest.max_age_s or 0.0) * 1e3:g} ms, the `max_age` of `{shortest.name}`"
            message = f"the clock offset of `{device.name}` must be below {age}, got {offset}"
            related = (Related("the age is limited here", graph.cell.locate(*shortest.path, "max_age")),)
            yield found(graph, path, message, related=related)
