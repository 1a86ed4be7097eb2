"""The recovery or the observer's place has no owner.

A procedure without an owner is not trained, and no person is at the stop button.

Example that is reported:

```yaml
safety: {recovery: {observer: UNKNOWN}}  # expect at observer
```

Example that is accepted:

```yaml
safety: {recovery: {observer: operator}}
```

Fix: name the owner of the procedure and the observer at the stop.

Source: docs/principles.md#recovery
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield the procedures without an owner, in one finding."""
    if not any(controller.command_interfaces for controller in graph.cell.controllers):
        return
    missing = [item for item in graph.responsibilities.of_kind("procedure") if item.open]
    if missing:
        names = " and ".join(item.name for item in missing)
        message = f"no person is named for {names}"
        yield found(graph, missing[0].path, message)
