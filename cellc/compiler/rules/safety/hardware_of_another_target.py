"""A target is said to run on the hardware of another one.

What `mock` and `real` start is decided by their names: the components of the catalog for the mock, and those of the
vendor. Who reads that the real target has mock hardware, and starts it to try something, moves the arm.

Example that is reported:

```yaml
targets: {real: {hardware: mock}}  # expect at hardware
```

Example that is accepted:

```yaml
targets: {real: {hardware: real}}
```

Fix: write the hardware of the target's name, and start the target that is meant.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("real-hardware-in-mock",))
def check(graph: CellGraph) -> Findings:
    """Yield the targets `mock` and `real` with hardware of another name."""
    for name in ("mock", "real"):
        target = graph.cell.targets[name]
        if target.hardware != name:
            message = f"target `{name}` starts `{name}` hardware in any case, got `{target.hardware}`"
            yield found(graph, ("targets", name, "hardware"), message)
