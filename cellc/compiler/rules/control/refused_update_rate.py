"""A device does not accept the update rate.

The driver exchanges commands at a fixed rate. A manager with another one repeats or drops commands, and the arm hums
or stops with a communication error.

Example that is reported:

```yaml
control: {update_rate: 400 Hz}  # expect at update_rate
```

Example that is accepted:

```yaml
control: {update_rate: 500 Hz}
```

Fix: use a rate of the device.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield managers whose rate a device that they drive does not list."""
    for manager in graph.cell.managers:
        for device in (graph.cell.device(name) for name in manager.devices):
            rates = device.update_rates_hz
            if rates and all(abs(rate - manager.update_rate_hz) > 1e-9 for rate in rates):
                accepted = " or ".join(f"{rate:g} Hz" for rate in rates)
                message = f"`update_rate` for `{device.name}` must be {accepted}, got {manager.update_rate_hz:g} Hz"
                path = (*manager.path, "update_rate")
                yield found(graph, path, message, f"write {accepted}, or give the device a manager of its own")
