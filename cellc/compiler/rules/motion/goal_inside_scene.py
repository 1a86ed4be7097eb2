"""A goal lies within something solid.

The tip, where the part is held, would stand inside a box of the scene. Open fingers can miss the box on both sides, so
that the collision check lets it pass: the part between them cannot.

Example that is reported:

```yaml
scene: {table: {parent: world, xyz: 450 0 820 mm, box: 500 900 40 mm}}
motion:
  goals:
    place: {frame: fixture_A, rpy: 180 0 0 deg, xyz: 0 0 -20 mm, approach: 0 0 -100 mm}  # expect at place
```

Example that is accepted:

```yaml
scene: {table: {parent: world, xyz: 450 0 820 mm, box: 500 900 40 mm}}
motion:
  goals:
    place: {frame: fixture_A, rpy: 180 0 0 deg, xyz: 0 0 10 mm, approach: 0 0 -100 mm}
```

Fix: check the sign of the offset and the place of the box.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.cell.frame import SceneBox
from cellc.compiler.rules.geometry import SOUND_MODEL
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.transforms import Pose

_WIDER_M = 0.15
"""A gripper may stand with open fingers astride what is narrower than this."""
_SURFACE_M = 0.002


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, "goal-in-collision", "infeasible-approach"))
def check(graph: CellGraph) -> Findings:
    """Yield goals whose tip is inside a box of the scene that no gripper spans."""
    for goal in graph.cell.goals:
        place = graph.frames.in_world(goal.frame)
        for box in graph.cell.scene if place is not None else ():
            parent = graph.frames.in_world(box.parent)
            if place is None or parent is None or sorted(box.size)[1] < _WIDER_M:
                continue
            deep_m = _depth(box, parent, place @ goal.transform_tip_to_frame)
            if deep_m > _SURFACE_M:
                message = f"goal `{goal.name}` must lie outside of `{box.name}`, got {deep_m * 1e3:.3g} mm within it"
                related = (Related("the box", box.span), Related("its frame", graph.cell.locate("frames", goal.frame)))
                yield found(graph, goal.path, message, related=related)
                break


def _depth(box: SceneBox, parent: Pose, tip: Pose) -> float:
    """Return how deep the tip lies in a box, m; negative outside."""
    local = (parent @ box.transform_to_parent).inverse().apply(tip.position)
    return min(size / 2 - abs(along) for size, along in zip(box.size, local, strict=True))
