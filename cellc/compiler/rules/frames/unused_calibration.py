"""No transform uses a calibration.

A measurement that nothing uses is usually one that was meant for a frame which still carries the old value.

Example that is reported:

```yaml
calibrations:
  spare: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm,  # expect at spare
          owner: perception}
```

Example that is accepted:

```yaml
calibrations:
  spare: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, calibration: spare}
```

Fix: name it at the frame or mount that it measured, or delete it.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations that no frame and no mount names."""
    used = {frame.calibration for frame in graph.cell.frames}
    for name in graph.cell.calibrations:
        if name not in used:
            message = f"no frame rests on calibration `{name}`"
            designed = [frame for frame in graph.cell.frames if frame.designed]
            related = tuple(Related("designed, without a measurement", frame.span) for frame in designed)
            yield found(graph, ("calibrations", name), message, related=related)
