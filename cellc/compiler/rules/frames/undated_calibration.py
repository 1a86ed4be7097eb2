"""A calibration has no date.

A measurement without a date cannot be compared with the day on which the camera was bumped.

Example that is reported:

```yaml
calibrations:
  fixture_a: {revision: 2, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception,
              measured: UNKNOWN}  # expect at measured
```

Example that is accepted:

```yaml
calibrations:
  fixture_a: {revision: 2, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception, measured: 2026-07-02}
```

Fix: write the day of the measurement as YYYY-MM-DD.

Source:

- docs/principles.md#calibration
- https://www.iso.org/standard/70907.html (ISO 8601-1:2019): dates
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations whose `measured` is no date."""
    for name, calibration in graph.cell.calibrations.items():
        if calibration.measured_on is None:
            message = f"`measured` of calibration `{name}` must be a date, got `{calibration.measured}`"
            yield found(graph, ("calibrations", name, "measured"), message)
