"""A dynamic frame has no publisher.

Every lookup of the frame fails, and the goals that rest on it end in a TF failure.

Example that is reported:

```yaml
frames:
  part: {parent: world, dynamic: true, rate: 10 Hz}  # expect at part
```

Example that is accepted:

```yaml
frames:
  part: {parent: world, dynamic: true, rate: 10 Hz, published_by: perception}
```

Fix: add `published_by:` with the one node or device that broadcasts it.

Source: docs/principles.md#one-authority-for-each-frame
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames without a publisher."""
    for frame in graph.cell.frames:
        if frame.kind is FrameKind.DYNAMIC and not graph.cell.states(*frame.path, "published_by"):
            message = f"dynamic frame `{frame.name}` has no publisher"
            yield found(graph, frame.path, message)
