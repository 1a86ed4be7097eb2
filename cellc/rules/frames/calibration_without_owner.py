"""A calibration has no owner.

Nobody is asked when it is in doubt, and nobody repeats it after the camera was touched.

Example that is reported:

```yaml
calibrations:
  fixture_a: {revision: 2, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm,
              owner: UNKNOWN}  # expect at owner
```

Example that is accepted:

```yaml
calibrations:
  fixture_a: {revision: 2, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
```

Fix: name the role or the team that answers for it, as its `owner:`.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations that nobody answers for."""
    for item in graph.responsibilities.of_kind("calibration"):
        if item.open:
            message = f"nobody answers for calibration `{item.name}`"
            yield found(graph, item.path, message)
