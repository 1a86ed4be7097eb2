"""The cell starts in a collision.

Without a pose `home` every joint begins at the home of its device, or at zero. There something touches, so that no
planner finds a first motion and every rehearsal ends before it moves.

Example that is reported:

```yaml
scene:
  wall: {parent: world, xyz: 700 100 1000 mm, box: 100 1000 400 mm}
motion:
  poses: {home: null, ready: {manipulator: 0 -90 90 -90 -90 0 deg}}  # expect at poses
rehearsals:
  pick_and_place: {steps: [move: ready]}
```

Example that is accepted:

```yaml
scene:
  wall: {parent: world, xyz: 700 100 1000 mm, box: 100 1000 400 mm}
motion:
  poses: {home: {manipulator: 0 -90 90 -90 -90 0 deg}, ready: {manipulator: 0 -90 90 -90 -90 0 deg}}
```

Fix: declare a pose `home` of all groups that is free of collision.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES, named
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def check(graph: CellGraph) -> Findings:
    """Yield a start in which something touches, where no pose `home` says so already."""
    contacts = motion_answer(graph).start
    if contacts and all(pose.name != "home" for pose in graph.cell.poses):
        message = f"where the cell begins {named(contacts)}"
        yield found(graph, ("motion", "poses"), message)
