"""No transform rests on a calibration.

A measurement that nothing uses is usually one that was meant for a frame which still carries the old value.

Example that is reported:

```yaml
calibrations:
  spare: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
```

Example that is accepted:

```yaml
calibrations:
  spare: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, owner: perception}
frames:
  tray: {parent: world, calibration: spare}
```

Fix: name it at the frame or mount that it measured, or delete it.

Source: chapter 4, section 3.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield calibrations that no frame and no mount names."""
    used = {frame.calibration for frame in graph.cell.frames}
    for name in graph.cell.spec.calibrations:
        if name not in used:
            message = f"no frame rests on calibration `{name}`"
            yield found(graph, ("calibrations", name), message, "name it at the frame that it measured, or delete it")


RULE = define("unused-calibration", Severity.WARNING, check, __doc__)
