"""A calibration has no owner.

No one is responsible when it is in doubt, or repeats it after the camera was touched.

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

Fix: name the responsible role or team as its `owner:`.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations without an owner."""
    for item in graph.responsibilities.of_kind("calibration"):
        if item.open:
            message = f"calibration `{item.name}` has no owner"
            yield found(graph, item.path, message)
