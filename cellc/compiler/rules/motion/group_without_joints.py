"""A planning group moves nothing.

Between its base and its tip there is no moving joint, so there is nothing to plan.

Example that is reported:

```yaml
motion:
  groups: {fingers: {base: arm/tool0, tip: tcp}}  # expect at fingers
```

Example that is accepted:

```yaml
motion:
  groups: {fingers: {base: arm/base_link, tip: tcp}}
```

Fix: choose base and tip at the two ends of the joints.

Source: docs/principles.md#planning-and-execution
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield groups without a joint."""
    for group in graph.cell.groups:
        if not group.joints:
            message = f"there is no moving joint between `{group.base_link}` and `{group.tip_frame}`"
            yield found(graph, group.path, message)
