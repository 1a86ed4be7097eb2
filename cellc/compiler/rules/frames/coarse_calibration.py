"""A calibration is too coarse for what rests on it.

The residual says how far the measured points lie from the fitted transform. A gripper that closes on a part, or a part
that goes into a fixture, forgives a few millimeters; beyond that a measurement has failed, whatever its date.

Example that is reported:

```yaml
calibrations:
  hand_eye: {residual: 14 mm}  # expect at residual
```

Example that is accepted:

```yaml
calibrations:
  hand_eye: {residual: 0.8 mm}
```

Fix: measure again, with more and more different poses, and keep the one with the small residual.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_COARSEST_M = 0.005


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations that a frame rests on with a residual of more than 5 mm."""
    for calibration in graph.cell.calibrations.values():
        residual_m = calibration.residual_m
        users = [frame for frame in graph.cell.frames if frame.calibration == calibration.name]
        if users and residual_m is not None and residual_m > _COARSEST_M:
            path = (*calibration.path, "residual")
            message = f"the residual of `{calibration.name}` must be at most {_COARSEST_M * 1e3:g} mm,"
            related = tuple(Related("rests on it", user.span) for user in users)
            yield found(graph, path, f"{message} got {graph.cell.text(*path)}", related=related)
