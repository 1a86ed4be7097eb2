"""A dynamic frame states a fixed pose.

The pose would never be used: the publisher sends another one. A reader of the file would believe it.

Example that is reported:

```yaml
frames:
  part: {parent: world, xyz: 1 0 0 m, dynamic: true, published_by: perception, rate: 10 Hz}  # expect at xyz
```

Example that is accepted:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz}
```

Fix: remove `xyz` and `rpy`; the mock reads `simulated_pose`.

Source: docs/principles.md#one-authority-for-each-frame
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames with a transform or a calibration of their own."""
    for frame in graph.cell.frames:
        field = next((key for key in ("xyz", "rpy", "calibration") if graph.cell.states(*frame.path, key)), None)
        if frame.kind is FrameKind.DYNAMIC and field is not None:
            message = f"frame `{frame.name}` is dynamic but states `{field}`"
            yield found(graph, (*frame.path, field), message)
