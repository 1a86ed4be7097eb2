"""A node has no owner.

When it fails, or when its parameters change, no one is responsible.

Example that is reported:

```yaml
nodes:
  tracker: {run: cell_tasks/tracker, host: control_pc, lifecycle: true}  # expect at tracker
```

Example that is accepted:

```yaml
nodes:
  tracker: {run: cell_tasks/tracker, host: control_pc, owner: integration, lifecycle: true}
```

Fix: add `owner:` with the responsible role or team.

Source: docs/principles.md#owners-and-approvals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield nodes of the spec without an owner."""
    for item in graph.responsibilities.of_kind("node"):
        if item.open:
            yield found(graph, item.path, f"node `{item.name}` has no owner")
