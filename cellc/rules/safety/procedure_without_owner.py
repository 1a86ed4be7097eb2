"""The recovery or the observer's place has no owner.

A procedure that nobody owns is not trained, and the place at the stop button stays empty.

Example that is reported:

```yaml
safety: {recovery: {observer: UNKNOWN}}  # expect at observer
```

Example that is accepted:

```yaml
safety: {recovery: {observer: operator}}
```

Fix: name who owns the procedure and who stands at the stop.

Source: docs/principles.md#recovery
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield the procedures that nobody owns, in one finding."""
    if not any(controller.command_interfaces for controller in graph.cell.controllers):
        return
    missing = [item for item in graph.responsibilities.of_kind("procedure") if item.open]
    if missing:
        names = " and ".join(item.name for item in missing)
        message = f"nobody is named for {names}"
        yield found(graph, missing[0].path, message)
