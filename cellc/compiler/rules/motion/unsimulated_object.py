"""A rehearsal detects an object that the mock cannot place.

The mock has no world. Where the thing lies that a dynamic frame follows must be said, or the rehearsal can only
fail.

Example that is reported:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz}  # expect at part
rehearsals:
  look: {steps: [detect: part]}
```

Example that is accepted:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz,
         simulated_pose: {parent: world, xyz: 400 0 900 mm}}
rehearsals:
  look: {steps: [detect: part]}
```

Fix: add `simulated_pose:` to the frame.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames that a rehearsal detects and that have no simulated pose."""
    detected = {step.name for rehearsal in graph.cell.rehearsals for step in rehearsal.steps if step.kind == "detect"}
    for frame in graph.cell.frames:
        if frame.kind is FrameKind.DYNAMIC and frame.name in detected and frame.simulated_pose is None:
            message = f"a rehearsal detects `{frame.name}`, but the mock does not know where it is"
            yield found(graph, frame.path, message)
