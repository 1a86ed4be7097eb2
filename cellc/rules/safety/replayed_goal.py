"""An old goal is resumed after a reconnect.

The goal was made for a scene that has changed since. The arm starts to move the moment that the cable is back.

Example that is reported:

```yaml
safety: {recovery: {on_reconnect: resume_goal}}
```

Example that is accepted:

```yaml
safety: {recovery: {on_reconnect: discard_goal}}
```

Fix: discard it, and plan again from fresh state.

Source: chapter 4, section 11, troubleshooting: motion after reconnect, stale goal replay.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield a recovery that resumes goals."""
    if graph.cell.spec.safety.recovery.on_reconnect == "resume_goal":
        path = ("safety", "recovery", "on_reconnect")
        yield found(graph, path, "an old goal is resumed after a reconnect", "write `on_reconnect: discard_goal`")


RULE = define("replayed-goal", Severity.ERROR, check, __doc__)
