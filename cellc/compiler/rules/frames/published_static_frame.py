"""A static frame names a publisher or a rate.

Static frames stand in the robot description and are published once, by robot_state_publisher. A node that publishes
the same frame is a second authority.

Example that is reported:

```yaml
frames:
  tray: {parent: world, designed: true, published_by: perception}  # expect at published_by
```

Example that is accepted:

```yaml
frames:
  tray: {parent: world, dynamic: true, published_by: perception, rate: 5 Hz}
```

Fix: write `dynamic: true` if it moves, or remove `published_by` and `rate`.

Source: docs/principles.md#one-authority-for-each-frame
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield static frames with a publisher or a rate."""
    for frame in graph.cell.frames:
        field = next((key for key in ("published_by", "rate") if graph.cell.states(*frame.path, key)), None)
        if frame.kind is FrameKind.FIXED and field is not None:
            message = f"frame `{frame.name}` is static but states `{field}`"
            yield found(graph, (*frame.path, field), message, f"write `dynamic: true`, or remove `{field}`")
