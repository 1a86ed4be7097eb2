"""The payload of an arm is below the mass of its tools.

The masses of the mounted devices alone exceed the payload set in the controller.

Example that is reported:

```yaml
devices: {arm: {payload: {mass: 0.1 kg, center_of_mass: 0 0 58 mm}}}  # expect at mass
```

Example that is accepted:

```yaml
devices: {arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm}}}
```

Fix: weigh the tool with everything that is screwed to it, cables included.

Source: docs/principles.md#payload
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_ROUNDING_KG = 0.05  # masses of descriptions are rounded, and a mounting plate may be part of either


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield arms whose payload is below the sum of masses of what they carry."""
    for device in graph.cell.devices:
        payload = device.payload
        if payload is None or device.kind != "arm":
            continue
        mass = graph.cell.carried_mass_kg(device)
        if mass > payload.mass_kg + _ROUNDING_KG:
            path = (*device.path, "payload", "mass")
            message = f"`{device.name}` carries {mass:.3g} kg, but its payload is {graph.cell.text(*path)}"
            yield found(graph, path, message, f"write at least {mass:.3g} kg")
