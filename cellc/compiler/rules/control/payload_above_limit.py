"""The payload of an arm is above its limit.

Beyond its payload the arm keeps neither its path nor its stopping distance.

Example that is reported:

```yaml
devices: {arm: {payload: {mass: 50 kg, center_of_mass: 0 0 58 mm}}}  # expect at mass
```

Example that is accepted:

```yaml
devices: {arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm}}}
```

Fix: choose a lighter tool or another arm.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield payloads above that of the device."""
    for device in graph.cell.devices:
        payload, limit_kg = device.payload, device.payload_limit_kg
        if payload is not None and limit_kg is not None and payload.mass_kg > limit_kg:
            path = (*device.path, "payload", "mass")
            message = f"the payload of `{device.name}` must be at most {limit_kg:g} kg, got {graph.cell.text(*path)}"
            yield found(graph, path, message)
