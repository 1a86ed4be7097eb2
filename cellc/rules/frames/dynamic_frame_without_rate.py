"""A dynamic frame has no rate.

Without a rate nobody can say how old a transform may be, how long the buffer has to be, or when the publisher is
late.

Example that is reported:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception}
```

Example that is accepted:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz}
```

Fix: write the rate at which it is published.

Source: chapter 4, section 3, acceptance gate 4.
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames without a rate."""
    for name, frame in graph.cell.spec.frames.items():
        if frame.dynamic and frame.rate is None:
            message = f"dynamic frame `{name}` has no rate"
            yield found(graph, ("frames", name), message, "add `rate:`, such as `10 Hz`")
