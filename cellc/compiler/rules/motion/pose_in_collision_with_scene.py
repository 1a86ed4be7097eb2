"""The robot touches the scene in a named pose.

A link and a declared solid thing are at one place. The planner refuses the pose, or the scene is not where it was
declared and the next plan goes through the real thing.

Example that is reported:

```yaml
scene:
  table: {parent: world, xyz: 350 0 700 mm, box: 900 1200 40 mm}
motion:
  poses: {low: {manipulator: 0 40 0 -90 -90 0 deg}}  # expect at manipulator
```

Example that is accepted:

```yaml
scene:
  table: {parent: world, xyz: 350 0 700 mm, box: 900 1200 40 mm}
motion:
  poses: {low: {manipulator: 0 0 0 -90 -90 0 deg}}
```

Fix: change the pose, or correct place and size of the box.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES, named, with_scene
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=KNOWN_POSES)
def check(graph: CellGraph) -> Findings:
    """Yield each pose in which a link touches a box of the scene."""
    paths = {pose.name: pose.path for pose in reversed(graph.cell.poses)}
    for pose in motion_answer(graph).poses:
        contacts = with_scene(graph, pose.contacts)
        if contacts:
            message = f"in pose `{pose.name}` {named(contacts)}"
            yield found(graph, paths[pose.name], message)
