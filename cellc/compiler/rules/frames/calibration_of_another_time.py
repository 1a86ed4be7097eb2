"""A calibration is years apart from the others of the cell.

It was measured before the tool or the camera was last taken off, or its date is mistyped. A check must not change its
answer with the clock of the machine that runs it, so that the other measurements of the cell stand for today.

Example that is reported:

```yaml
calibrations:
  tcp: {measured: 2019-03-01}  # expect at measured
```

Example that is accepted:

```yaml
calibrations:
  tcp: {measured: 2026-03-01}
```

Fix: measure again, or correct the date.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

import datetime
from collections.abc import Sequence

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_APART = datetime.timedelta(days=366)


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations more than a year before or after the largest group of those that lie nearer together."""
    dated = [calibration for calibration in graph.cell.calibrations.values() if calibration.measured_on is not None]
    common = _common([calibration.measured_on for calibration in dated if calibration.measured_on is not None])
    for calibration in dated:
        if calibration.measured_on is None or calibration.measured_on in common:
            continue
        side = "before" if calibration.measured_on < common[0] else "after"
        message = f"`{calibration.name}` must be measured within a year of the others, which were between"
        message += f" {common[0]} and {common[-1]}, got {calibration.measured_on}, {side} all of them"
        yield found(graph, (*calibration.path, "measured"), message)


def _common(dates: Sequence[datetime.date]) -> list[datetime.date]:
    """Return the largest group of dates without a gap of more than a year, the later of two equal ones."""
    groups: list[list[datetime.date]] = []
    for date in sorted(dates):
        if groups and date - groups[-1][-1] <= _APART:
            groups[-1].append(date)
        else:
            groups.append([date])
    return max(groups, key=lambda group: (len(group), group[-1]), default=[])
