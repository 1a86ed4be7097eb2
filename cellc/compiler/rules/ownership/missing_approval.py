"""An approval area has no owner.

Before the cell moves, seven questions are answered with evidence. Without an owner no one signs, or anyone does.

Example that is reported:

```yaml
owners:
  approvals: {safety: UNKNOWN}  # expect at safety
```

Example that is accepted:

```yaml
owners:
  approvals: {safety: safety}
```

Fix: name the role or the person who signs, under `owners.approvals`.

Source: docs/principles.md#owners-and-approvals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield the approval areas without an owner; those that the spec does not mention in one finding."""
    unwritten = []
    for item in graph.responsibilities.of_kind("approval"):
        if item.open and graph.cell.states(*item.path):
            yield found(graph, item.path, f"no owner approves `{item.name}`")
        elif item.open:
            unwritten.append(item.name)
    if unwritten:
        names = ", ".join(f"`{name}`" for name in unwritten)
        path = ("owners", "approvals")
        yield found(graph, path, f"no owner approves {names}")
