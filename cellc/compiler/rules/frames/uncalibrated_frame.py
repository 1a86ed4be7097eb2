"""A measured transform names no calibration.

A static transform does not move during operation; that does not make it right forever. Without a calibration id
it is unknown which measurement a goal used, nor notice that a bumped camera still uses the old one.

Example that is reported:

```yaml
frames:
  tray: {parent: world, xyz: 0.4 0.1 0.8 m}  # expect at tray
```

Example that is accepted:

```yaml
calibrations:
  tray: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, xyz: 0.4 0.1 0.8 m, calibration: tray}
```

Fix: add `calibration:`, or `designed: true` if the value comes from a drawing.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield fixed frames and camera mounts without a calibration."""
    cameras = {device.name for device in graph.cell.devices if device.kind == "camera"}
    for frame in graph.cell.frames:
        measured = frame.kind is FrameKind.FIXED or (frame.kind is FrameKind.MOUNT and frame.device in cameras)
        if measured and not frame.designed and frame.calibration is None:
            message = f"the pose of `{frame.name}` in `{frame.parent}` names no calibration"
            yield found(graph, frame.path, message)
