"""Frames hang together but not on the world.

No lookup connects them with the rest of the cell, so a goal in one of them fails with a TF error at run time.

Example that is reported:

```yaml
frames:
  left: {parent: right, designed: true}
  right: {parent: left, designed: true}
```

Example that is accepted:

```yaml
frames:
  left: {parent: world, designed: true}
  right: {parent: left, designed: true}
```

Fix: connect the topmost of them with a parent that reaches the world.

Source: REP-105: the frames of a robot form one tree.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.frame import WORLD
from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield each set of frames without a way to the world, at its first frame."""
    for island in graph.frames.islands():
        frames = [graph.frames.authorities(name)[0] for name in graph.frames.names() if name in island]
        others = f" and {len(frames) - 1} below it" if len(frames) > 1 else ""
        message = f"frame `{frames[0].name}`{others} cannot be reached from `{WORLD}`"
        yield found(graph, frames[0].path, message, f"give it a parent that leads to `{WORLD}`")


RULE = define("frame-island", Severity.ERROR, check, __doc__, assumes=("several-root-links", "joint-of-unknown-link"))
