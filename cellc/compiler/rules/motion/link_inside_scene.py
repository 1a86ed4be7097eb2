"""A link touches something solid of the scene in every posture.

A planner would never plan with such a pair, so that the collision check takes it out: Setup Assistant of MoveIt writes
it to the SRDF as "Always", and no tool complains. From then on the link goes through the thing unnoticed. The
box is at the wrong place or too large, or the device is mounted at the wrong place.

Example that is reported:

```yaml
scene:
  post: {parent: world, xyz: 0 0 960 mm, box: 60 60 40 mm}  # expect at post
```

Example that is accepted:

```yaml
scene:
  post: {parent: world, xyz: 0 0 900 mm, box: 60 60 40 mm}
```

Fix: correct the place or the size of the box, or the mount of the device.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from collections.abc import Sequence

from cellc.compiler.feasibility import BodyContact, motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES, mounts, with_scene
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def check(graph: CellGraph) -> Findings:
    """Yield boxes of the scene that are out of the check against links that move towards and away from them."""
    unchecked = with_scene(graph, motion_answer(graph).rigid)
    for box in graph.cell.scene:
        contacts = [
            contact
            for contact in unchecked
            if box.name in (contact.first, contact.second) and _moves(graph, box.parent, _other(contact, box.name))
        ]
        if contacts:
            links = ", ".join(f"`{_other(contact, box.name)}`" for contact in contacts)
            message = f"`{box.name}` touches {links} in every posture, so that this contact is not checked"
            yield found(graph, box.path, message, related=mounts(graph, contacts))


def _other(contact: BodyContact, name: str) -> str:
    return contact.second if contact.first == name else contact.first


def _moves(graph: CellGraph, parent: str, link: str) -> bool:
    """Tell whether a joint moves a link against what carries a box."""
    return _joints(graph, parent) != _joints(graph, link)


def _joints(graph: CellGraph, name: str) -> Sequence[str]:
    return [frame.name for frame in graph.frames.chain(name) if frame.moving]
