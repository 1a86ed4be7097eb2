"""A calibration does not say how good it is.

Without the number of samples and the residual, a result of 0.3 mm over 40 views and a guess look alike.

Example that is reported:

```yaml
calibrations:
  spare: {revision: 1, measured: 2026-07-02, method: touch probe, owner: perception}  # expect at spare
frames:
  tray: {parent: world, calibration: spare}
```

Example that is accepted:

```yaml
calibrations:
  spare: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, calibration: spare}
```

Fix: write `samples` and `residual` of the fit.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations without samples, residual or method."""
    for name, calibration in graph.cell.calibrations.items():
        stated = (
            ("method", calibration.method),
            ("samples", calibration.samples),
            ("residual", calibration.residual_m),
        )
        missing = [field for field, value in stated if value is None or value == UNKNOWN]
        if missing:
            fields = ", ".join(f"`{field}`" for field in missing)
            message = f"calibration `{name}` does not state {fields}"
            yield found(graph, ("calibrations", name), message, f"write {fields}")
