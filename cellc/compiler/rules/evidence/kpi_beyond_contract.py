"""An interface promises less than a key figure demands.

The target can be missed while every part keeps its contract.

Example that is reported:

```yaml
interfaces:
  /move_action: {cancel_within: 800 ms}  # expect at cancel_within
```

Example that is accepted:

```yaml
interfaces:
  /move_action: {cancel_within: 150 ms}
```

Fix: tighten the contract, or loosen the target.

Source: docs/principles.md#key-figures
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield actions whose cancel may take longer than the target."""
    target = graph.cell.kpis.cancel_s
    for interface in graph.cell.interfaces if target is not None else ():
        bound = interface.cancel_within_s
        if target is not None and bound is not None and bound > target and not interface.derived:
            allowed = graph.cell.text("kpis", "cancel")
            message = (
                f"`cancel_within` of `{interface.name}` must be at most the target of {allowed}, got {bound * 1e3:g} ms"
            )
            related = (Related("the target is here", graph.cell.locate("kpis", "cancel")),)
            yield found(graph, (*interface.path, "cancel_within"), message, related=related)
