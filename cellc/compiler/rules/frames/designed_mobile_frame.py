"""The pose of a mobile device is stated by design.

A cart, a vehicle or a pallet never docks twice at one point. Written as `designed`, its docking error is in every goal
on it and nowhere in the figures.

Example that is reported:

```yaml
frames:
  cart_top: {parent: world, xyz: 0 1 0.75 m, designed: true}  # expect at designed
```

Example that is accepted:

```yaml
frames:
  cart_top: {parent: world, xyz: 0 1 0.75 m, calibration: dock}
calibrations:
  dock: {revision: 1, measured: 2026-07-02, method: laser tracker, samples: 12, residual: 0.5 mm, owner: perception}
```

Fix: measure it with a `calibration:`, or let a node publish it as `dynamic: true`.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

import re

from cellc.compiler.cell.frame import WORLD
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_WORDS = frozenset(
    ("agv", "amr", "cart", "carriage", "forklift", "mobile", "pallet", "shuttle", "trolley", "vehicle", "wagon")
)


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield designed frames on the world with such a word in their name."""
    for frame in graph.cell.frames:
        words = re.findall(r"[a-z]+", frame.name.lower())
        mobile = next((word for word in words if word in _WORDS), None)
        if frame.designed and frame.parent == WORLD and mobile is not None:
            message = f"`{frame.name}` must be measured or published, as a {mobile} does not stand by design"
            yield found(graph, (*frame.path, "designed"), message)
