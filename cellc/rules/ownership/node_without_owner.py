"""A node has no owner.

When it fails, or when its parameters change, nobody is asked.

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

Fix: add `owner:` with the role or the team that answers for it.

Source: docs/principles.md#owners-and-approvals
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield nodes of the spec that nobody answers for."""
    for item in graph.responsibilities.of_kind("node"):
        if item.open:
            yield found(graph, item.path, f"nobody answers for node `{item.name}`")
