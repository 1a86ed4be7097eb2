"""A responsibility has no owner.

Frames, time, limits, watchdogs, commands, logs, the vendor's safety configuration and the physical stop: whatever the
architecture, each has an owner. A stack only hides the question, an SDK returns it.

Example that is reported:

```yaml
owners:
  responsibilities: {limits: UNKNOWN}  # expect at limits
```

Example that is accepted:

```yaml
owners:
  responsibilities: {limits: controls}
```

Fix: name the responsible role or team under `owners.responsibilities`.

Source: docs/principles.md#responsibilities
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield the responsibilities without an owner; those that the spec does not mention in one finding."""
    unwritten = []
    for item in graph.responsibilities.of_kind("responsibility"):
        if item.open and graph.cell.states(*item.path):
            yield found(graph, item.path, f"`{item.name}` has no owner")
        elif item.open:
            unwritten.append(item.name)
    if unwritten:
        names = ", ".join(f"`{name}`" for name in unwritten)
        path = ("owners", "responsibilities")
        yield found(graph, path, f"no owner for {names}")
