"""A calibration has no owner.

Nobody is asked when it is in doubt, and nobody repeats it after the camera was touched.

Example that is reported:

```yaml
calibrations:
  fixture_a: {revision: 2, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: UNKNOWN}
```

Example that is accepted:

```yaml
calibrations:
  fixture_a: {revision: 2, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
```

Fix: name the role or the team that answers for it.

Source: chapter 4, manufacturing cell checkpoint: the perception owner answers which calibration produced the goal.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield calibrations that nobody answers for."""
    for item in graph.responsibilities.of_kind("calibration"):
        if item.open:
            message = f"nobody answers for calibration `{item.name}`"
            yield found(graph, item.path, message, "name its owner")


RULE = define("calibration-without-owner", Severity.BLOCKER, check, __doc__)
