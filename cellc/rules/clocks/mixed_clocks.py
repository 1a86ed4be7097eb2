"""A node runs on another clock than its target.

If one node takes `/clock` and another wall time, transforms extrapolate, timeouts fire early or never, and a replay
shows something else than happened.

Example that is reported:

```yaml
nodes:
  perception: {clock: sim}  # expect at clock
```

Example that is accepted:

```yaml
nodes:
  perception: {clock: wall}
```

Fix: remove `clock:` from the node, so that it follows its target, or set the clock of the target.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield nodes whose clock is not that of a target that starts them."""
    targets = {name: target.clock for name, target in graph.cell.targets.items()}
    for node in graph.cell.nodes:
        other = next((target for target, clock in targets.items() if node.clock not in (None, clock)), None)
        if other is not None:
            message = f"node `{node.name}` runs on {node.clock} time, but target `{other}` on {targets[other]} time"
            yield found(graph, (*node.path, "clock"), message)
