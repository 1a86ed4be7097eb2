"""A cell that moves does not rehearse its failures.

That a stale image is rejected and that a cancel holds is known when it was made to happen. On the mock it costs
nothing.

Example that is reported:

```yaml
rehearsals: {stale_camera: null}  # expect at rehearsals
```

Example that is accepted:

```yaml
rehearsals:
  stale_camera: {use: pick_and_place, inject: {freeze: camera, at: 2 s}, expect: stale_state}
```

Fix: add rehearsals that inject the fault and expect its outcome.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield a cell with observed goals that rehearses no stale state, or no cancel, in one finding."""
    dynamic = {frame.name for frame in graph.cell.frames if frame.kind is FrameKind.DYNAMIC}
    if not graph.cell.rehearsals or not any(goal.frame in dynamic for goal in graph.cell.goals):
        return
    expected = {rehearsal.expect for rehearsal in graph.cell.rehearsals}
    missing = [outcome for outcome in ("stale_state", "cancelled") if outcome not in expected]
    if missing:
        names = " and ".join(f"`{outcome}`" for outcome in missing)
        yield found(graph, ("rehearsals",), f"no rehearsal ends in {names}")
