"""A target with real hardware runs on simulated time.

No node publishes `/clock` beside a real robot. Time stays at zero: timers never fire, no transform is ever fresh, and a
recording that is played beside it moves the time of the cell.

Example that is reported:

```yaml
targets: {real: {hardware: real, clock: sim}}  # expect at clock
```

Example that is accepted:

```yaml
targets: {real: {hardware: real, clock: wall}}
```

Fix: write `clock: wall`; only a simulator or a replay publishes `/clock`.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("real-hardware-in-mock",))
def check(graph: CellGraph) -> Findings:
    """Yield targets with real hardware and the clock of a simulator."""
    for name, target in graph.cell.targets.items():
        if target.hardware == "real" and target.clock == "sim":
            path = ("targets", name, "clock")
            message = f"the clock of target `{name}` must be wall, as its hardware is real, got sim"
            yield found(graph, path, message)
