"""Two different transforms use one calibration.

One ID is one measurement. Where two frames with different parents or values name it, at least one of them
carries a value that was not measured, and a new revision silently changes both.

Example that is reported:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, xyz: 0.4 0.1 0.8 m, calibration: tray}
  bin: {parent: world, xyz: 0.1 0.5 0.8 m, calibration: tray}  # expect at calibration
```

Example that is accepted:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, xyz: 0.4 0.1 0.8 m, calibration: tray}
  bin: {parent: tray, xyz: 0.3 0 0 m, designed: true}
```

Fix: give each measurement its own id, or hang the second frame on the first with a designed transform.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.compiler.cell.frame import Frame
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield frames that reuse a calibration for another transform."""
    first: dict[str, Frame] = {}
    for frame in graph.cell.frames:
        if frame.calibration is None:
            continue
        earlier = first.setdefault(frame.calibration, frame)
        if (earlier.parent, earlier.transform_to_parent) != (frame.parent, frame.transform_to_parent):
            message = f"calibration `{frame.calibration}` gives `{frame.name}` another pose than `{earlier.name}`"
            related = (Related(f"first used for `{earlier.name}` here", earlier.span),)
            path = (*frame.path, "calibration")
            yield found(graph, path, message, related=related)
