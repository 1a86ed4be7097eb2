"""Every sample is already too old when it can be used.

At a given rate the newest sample is up to one period old, plus the exposure before its stamp is sent and the
transport after. A limit below that sum rejects fresh data, now and then or always, and is then switched off by
somebody.

Example that is reported:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 50 ms, on_stale: reject_goal}  # expect at max_age
```

Example that is accepted:

```yaml
interfaces:
  /markers: {topic: geometry_msgs/msg/PoseStamped, from: perception, to: {task: {depth: 1}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}
```

Fix: raise `max_age` above period + transport + exposure, or the rate.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield topics whose age limit is below their budget."""
    exposures = {
        device.name: device.stamp.exposure_s
        for device in graph.cell.devices
        if device.stamp is not None and device.stamp.exposure_s is not None
    }
    for interface in graph.cell.interfaces:
        if interface.max_age_s is None or not interface.rate_hz:
            continue
        exposure = max((exposures.get(source.node, 0.0) for source in interface.sources), default=0.0)
        transport = interface.transport_s or 0.0
        budget = 1.0 / interface.rate_hz + transport + exposure
        if interface.max_age_s < budget:
            age = interface.max_age_s * 1e3
            parts = (
                f"period {1e3 / interface.rate_hz:.4g}, transport {transport * 1e3:g}, exposure {exposure * 1e3:g} ms"
            )
            message = (
                f"`max_age` of `{interface.name}` must be at least {budget * 1e3:.4g} ms ({parts}), got {age:g} ms"
            )
            path = (*interface.path, "max_age")
            yield found(graph, path, message, f"allow at least {math.ceil(budget * 1e3)} ms, or raise the rate")
