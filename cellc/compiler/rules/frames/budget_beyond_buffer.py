"""A transform is forgotten before its goal is executed.

A goal rests on the transform at the stamp of its observation. The observation may be as old as its topic allows when
planning begins, and the key figure allows planning its own time; if the buffer is shorter than the sum, the lookup
before execution fails with an extrapolation error, or is made with a newer transform.

Example that is reported:

```yaml
frames:
  object: {buffer: 600 ms}  # expect at buffer
```

Example that is accepted:

```yaml
frames:
  object: {buffer: 2 s}
```

Fix: keep the frame at least for the age of the observation and the time to execution together.

Source: docs/principles.md#transforms-at-the-time-of-observation
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR, assumes=("short-transform-buffer",))
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames of goals whose buffer is below age limit plus plan-to-execute target."""
    target = graph.cell.kpis.plan_to_execute_s
    goals = {goal.frame for goal in graph.cell.goals}
    for frame in graph.cell.frames:
        if frame.kind is not FrameKind.DYNAMIC or frame.buffer_s is None or frame.name not in goals or target is None:
            continue
        oldest = _oldest(graph, frame.authority)
        if oldest is None or oldest.max_age_s is None or oldest.max_age_s + target <= frame.buffer_s:
            continue
        needed = oldest.max_age_s + target
        message = (
            f"`buffer` of `{frame.name}` must be at least {needed:g} s "
            f"(`{oldest.name}` {oldest.max_age_s:g} s + plan to execute {target:g} s), got {frame.buffer_s:g} s"
        )
        related = (
            Related("the age is allowed here", graph.cell.locate(*oldest.path, "max_age")),
            Related("the time to execution here", graph.cell.locate("kpis", "plan_to_execute")),
        )
        yield found(graph, (*frame.path, "buffer"), message, f"keep it for at least {needed:g} s", related)


def _oldest(graph: CellGraph, node: str) -> Interface | None:
    """Return the topic of a node whose samples may be oldest."""
    sent = [i for i in graph.cell.interfaces if i.max_age_s and any(source.node == node for source in i.sources)]
    return max(sent, key=lambda interface: interface.max_age_s or 0.0, default=None)
