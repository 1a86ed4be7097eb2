"""A rehearsal moves to an object that it has not detected.

A goal in a dynamic frame needs an observation and its stamp. Without one there is no time at which to look the frame
up.

Example that is reported:

```yaml
rehearsals:
  blind: {steps: [move: home, move: pick]}  # expect at move
```

Example that is accepted:

```yaml
rehearsals:
  seeing: {steps: [move: home, detect: object, move: pick]}
```

Fix: detect the frame before the move.

Source:

- docs/principles.md#rehearsals
- docs/principles.md#transforms-at-the-time-of-observation
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield moves to goals in a dynamic frame before a step that detects it."""
    goals = {goal.name: goal.frame for goal in graph.cell.goals}
    dynamic = {frame.name for frame in graph.cell.frames if frame.kind is FrameKind.DYNAMIC}
    reported: set[YamlPath] = set()
    for rehearsal in graph.cell.rehearsals:
        seen: set[str] = set()
        for step in rehearsal.steps:
            frame = goals.get(step.name, "") if step.kind == "move" else ""
            if step.kind == "detect":
                seen.add(step.name)
            elif frame in dynamic and frame not in seen and step.path not in reported:
                reported.add(step.path)
                message = f"`{rehearsal.name}` moves to `{step.name}` before it detects `{frame}`"
                yield found(graph, step.path, message, f"add the step `detect: {frame}` before it")
