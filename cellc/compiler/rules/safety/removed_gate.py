"""A promotion gate is missing or out of order.

The gates lead from power off to a short trajectory, each with its evidence. A gate that is skipped is the one whose
mistake moves the arm.

Example that is reported:

```yaml
bringup: {gates: [L1, L2, L3, L4, L5, L6, G0, G1, G2, G3, G4, G5, G7]}  # expect at gates
```

Example that is accepted:

```yaml
bringup: {gates: [L1, L2, L3, L4, L5, L6, G0, G1, G2, G3, G4, G5, G6, G7]}
```

Fix: write `gates: standard`, or all of them in order with your own between.

Source: docs/principles.md#promotion-gates
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import NETWORK_GATES, PROMOTION_GATES


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each ladder of gates that is not complete and in order."""
    gates = graph.cell.bringup.gates
    for ladder in (PROMOTION_GATES, NETWORK_GATES):
        written = [gate for gate in gates if gate in ladder]
        missing = [gate for gate in ladder if gate not in written]
        if missing:
            yield found(graph, ("bringup", "gates"), f"gate {', '.join(missing)} is missing")
        elif written != list(ladder):
            order = ", ".join(written)
            message = f"gates are out of order: {order}"
            yield found(graph, ("bringup", "gates"), message)
