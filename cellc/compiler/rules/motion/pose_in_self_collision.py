"""The robot touches itself in a named pose.

Two links that are no neighbors touch in this pose, so no planner goes there, and a controller that is commanded there
presses the arm against itself. A digit too many in an elbow is enough, and joint limits alone do not notice.

Example that is reported:

```yaml
motion:
  poses: {folded: {manipulator: 0 -90 170 -90 -90 0 deg}}  # expect at manipulator
```

Example that is accepted:

```yaml
motion:
  poses: {folded: {manipulator: 0 -90 130 -90 -90 0 deg}}
```

Fix: change the pose until the named links are apart.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES, mounts, named, within_robot
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=KNOWN_POSES)
def check(graph: CellGraph) -> Findings:
    """Yield each pose in which links touch links."""
    paths = {pose.name: pose.path for pose in reversed(graph.cell.poses)}
    for pose in motion_answer(graph).poses:
        contacts = within_robot(graph, pose.contacts)
        if contacts:
            message = f"in pose `{pose.name}` {named(contacts)}"
            yield found(graph, paths[pose.name], message, related=mounts(graph, contacts))
