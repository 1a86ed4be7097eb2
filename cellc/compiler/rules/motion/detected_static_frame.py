"""A rehearsal detects a frame that never changes.

A static frame is not observed, so the step would wait for a sample that no node sends.

Example that is reported:

```yaml
rehearsals:
  look: {steps: [detect: fixture_A]}  # expect at detect
```

Example that is accepted:

```yaml
rehearsals:
  look: {steps: [detect: object]}
```

Fix: remove the step, or detect the dynamic frame that is meant.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, did_you_mean, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield steps that detect a frame which is not dynamic, once where the steps are shared."""
    reported: set[YamlPath] = set()
    for step in (step for rehearsal in graph.cell.rehearsals for step in rehearsal.steps):
        frame = graph.frames.get(step.name) if step.kind == "detect" else None
        if frame is not None and frame.kind is not FrameKind.DYNAMIC and step.path not in reported:
            reported.add(step.path)
            dynamic = (f.name for f in graph.cell.frames if f.kind is FrameKind.DYNAMIC)
            message = f"`{step.name}` is static and cannot be detected"
            yield found(graph, step.path, message, did_you_mean(step.name, dynamic, "dynamic frames"))
