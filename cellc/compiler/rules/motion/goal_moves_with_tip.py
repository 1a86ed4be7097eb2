"""A goal is fixed to the arm that must reach it.

The frame of the goal moves with the joints of the group, so the distance between tip and goal never changes.

Example that is reported:

```yaml
frames:
  pocket: {parent: arm/tool0, xyz: 0 0 100 mm, designed: true}
motion:
  goals: {stow: {frame: pocket}}  # expect at frame
```

Example that is accepted:

```yaml
frames:
  pocket: {parent: world, xyz: 400 0 900 mm, designed: true}
motion:
  goals: {stow: {frame: pocket}}
```

Fix: give the goal in a frame that does not hang on the arm.

Source: docs/principles.md#direction-and-scale
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield goals in a fixed frame that hangs on a link moved by the goal's own group."""
    groups = {group.name: group for group in graph.cell.groups}
    children = {joint.child: joint.name for device in graph.cell.devices for joint in device.description.joints}
    for goal in graph.cell.goals:
        frame = graph.frames.get(goal.frame)
        if frame is None or frame.kind is FrameKind.DYNAMIC or goal.group not in groups:
            continue
        moved = {children[edge.name] for edge in graph.frames.chain(goal.frame) if edge.name in children}
        if not moved.isdisjoint(groups[goal.group].joints):
            message = f"goal `{goal.name}` is in `{goal.frame}`, which group `{goal.group}` moves itself"
            yield found(graph, (*goal.path, "frame"), message)
