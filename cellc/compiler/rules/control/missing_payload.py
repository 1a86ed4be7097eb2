"""An arm has no payload set.

The vendor's controller computes torques with the payload. With a wrong one the arm sinks, its collision detection
triggers for nothing or not at all, and the brakes are loaded.

Example that is reported:

```yaml
devices: {arm: {payload: null}}  # expect at arm
```

Example that is accepted:

```yaml
devices: {arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm}}}
```

Fix: weigh the tool, and add `payload:` with mass and center of mass at the flange.

Source: docs/principles.md#payload
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield arms that carry devices and state no payload."""
    for device in graph.cell.devices:
        if device.kind == "arm" and device.carries and device.payload is None:
            names = ", ".join(f"`{name}`" for name in device.carries)
            message = f"`{device.name}` carries {names}, but its payload is not stated"
            yield found(graph, device.path, message)
