"""A cell claims more than the limits of its device.

The share of a cell may only tighten. Above 100 % the planner makes trajectories that the joint cannot follow, or that
the vendor's controller ends with a protective stop.

Example that is reported:

```yaml
devices: {arm: {limits: {velocity: 150 %}}}  # expect at velocity
```

Example that is accepted:

```yaml
devices: {arm: {limits: {velocity: 50 %}}}
```

Fix: write 100 % or less.

Source: docs/principles.md#claims-and-switches
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield shares above 100 %."""
    for device in graph.cell.devices:
        shares = device.limit_shares
        for name, share in (("velocity", shares.velocity), ("acceleration", shares.acceleration)):
            if share > 1.0:
                path = (*device.path, "limits", name)
                text = graph.cell.text(*path)
                message = f"the {name} share of `{device.name}` must be at most 100 %, got {text}"
                yield found(graph, path, message)
