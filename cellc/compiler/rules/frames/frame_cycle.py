"""Frames form a cycle.

No frame of the circle has a pose in the world, and a lookup through it never ends or fails at run time.

Example that is reported:

```yaml
frames:
  left: {parent: right, designed: true}  # expect at parent
  right: {parent: left, designed: true}
```

Example that is accepted:

```yaml
frames:
  left: {parent: world, designed: true}
  right: {parent: left, designed: true}
```

Fix: let one frame of the circle hang on `world` or on a link.

Source: https://www.ros.org/reps/rep-0105.html (as of 2025-10-24): the frames of a robot form a tree
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each circle once, at the frame of it that is written first."""
    for cycle in graph.frames.cycles():
        first = next(name for name in graph.frames.names() if name in cycle)
        frame = graph.frames.authorities(first)[0]
        start = cycle.index(first)
        names = (*cycle[start:], *cycle[:start], first)
        message = "frames form a cycle: " + " → ".join(f"`{name}`" for name in names)
        yield found(graph, (*frame.path, "parent"), message)
