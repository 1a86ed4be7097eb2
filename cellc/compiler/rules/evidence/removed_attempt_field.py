"""An attempt does not record a required field.

Each of the fifteen fields separates two causes. Without the goal stamp a stale image looks like a planning failure;
without the controller's name it is unknown who moved.

Example that is reported:

```yaml
recording: {attempt_fields: [attempt_id, goal_frame, goal_stamp]}  # expect at attempt_fields
```

Example that is accepted:

```yaml
recording: {attempt_fields: standard}
```

Fix: write `attempt_fields: standard`, or list all of them with your own.

Source: docs/principles.md#records-of-attempts
"""

from __future__ import annotations

from cellc.compiler.cell.site import ATTEMPT_FIELDS
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the missing fields in one finding."""
    fields = graph.cell.recording.attempt_fields
    missing = [field for field in ATTEMPT_FIELDS if field not in fields]
    if missing:
        names = ", ".join(f"`{field}`" for field in missing)
        path = ("recording", "attempt_fields")
        yield found(graph, path, f"an attempt does not record {names}")
