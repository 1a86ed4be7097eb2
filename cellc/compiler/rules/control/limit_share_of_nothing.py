"""A cell leaves a device no speed.

A share of zero or less leaves no trajectory that ends. To hold an arm, deactivate its controller.

Example that is reported:

```yaml
devices: {arm: {limits: {velocity: 0 %}}}  # expect at velocity
```

Example that is accepted:

```yaml
devices: {arm: {limits: {velocity: 10 %}}}
```

Fix: write a share above zero.

Source: docs/principles.md#command-contracts
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield shares of zero and below."""
    for device in graph.cell.devices:
        shares = device.limit_shares
        for name, share in (("velocity", shares.velocity), ("acceleration", shares.acceleration)):
            if share <= 0.0:
                path = (*device.path, "limits", name)
                message = f"the {name} share of `{device.name}` must be above zero, got {graph.cell.text(*path)}"
                yield found(graph, path, message)
