"""A mock or simulated target reaches real hardware.

What is started to be safe would move the arm.

Example that is reported:

```yaml
targets: {mock: {hardware: real}}  # expect at hardware
```

Example that is accepted:

```yaml
targets: {mock: {hardware: mock}}
```

Fix: write the hardware of the target's name.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield targets other than real with real hardware."""
    for name, target in graph.cell.targets.items():
        if name != "real" and target.hardware == "real":
            path = ("targets", name, "hardware")
            yield found(graph, path, f"target `{name}` uses real hardware", f"write `hardware: {name}`")
