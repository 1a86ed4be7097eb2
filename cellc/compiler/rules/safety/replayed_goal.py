"""An old goal is resumed after a reconnect.

The goal was made for a scene that has changed since. The arm starts to move the moment that the cable is back.

Example that is reported:

```yaml
safety: {recovery: {on_reconnect: resume_goal}}  # expect at on_reconnect
```

Example that is accepted:

```yaml
safety: {recovery: {on_reconnect: discard_goal}}
```

Fix: write `on_reconnect: discard_goal`, and plan again from fresh state.

Source: docs/principles.md#restarts-and-reconnects
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a recovery that resumes goals."""
    if graph.cell.safety.recovery.on_reconnect == "resume_goal":
        path = ("safety", "recovery", "on_reconnect")
        yield found(graph, path, "an old goal is resumed after a reconnect")
