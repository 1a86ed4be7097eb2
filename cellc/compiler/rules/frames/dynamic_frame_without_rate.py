"""A dynamic frame has no rate.

Without a rate it is open how old a transform may be, how long the buffer must be, or when the publisher is
late.

Example that is reported:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception}  # expect at part
```

Example that is accepted:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz}
```

Fix: add `rate:`, such as `10 Hz`.

Source: docs/principles.md#one-authority-for-each-frame
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames without a rate."""
    for frame in graph.cell.frames:
        if frame.kind is FrameKind.DYNAMIC and frame.rate_hz is None:
            message = f"dynamic frame `{frame.name}` has no rate"
            yield found(graph, frame.path, message)
