"""An arm is to carry more than it can.

Beyond its payload the arm keeps neither its path nor its stopping distance.

Example that is reported:

```yaml
devices: {arm: {payload: {mass: 50 kg, center_of_mass: 0 0 58 mm}}}
```

Example that is accepted:

```yaml
devices: {arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm}}}
```

Fix: choose a lighter tool or another arm.

Source: payload of the device in the catalogue, with its source.
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield payloads above that of the device."""
    for device in graph.cell.devices:
        payload, limit = device.spec.payload, device.facts.limits.payload
        if payload is not None and limit is not None and payload.mass.si > limit.value.si:
            message = f"`{device.name}` is to carry {payload.mass.text}, at most {limit.value.text} are allowed"
            path = (*device.path, "payload", "mass")
            yield found(graph, path, message, "choose a lighter tool or another arm")
