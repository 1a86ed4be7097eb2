"""A mounted device lies inside another one.

Whatever the joints do, the two touch. The collision check of the planner takes such a pair out, because it would never
plan otherwise, so that no tool complains: one of the poses is wrong.

Example that is reported:

```xml
<link name="base">
  <collision><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
<!-- expect at devices.stage -->
```

Example that is accepted:

```xml
<link name="base">
  <collision><origin xyz="0 3 1"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link>
```

Fix: correct the mount of the one that is in the wrong place.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def check(graph: CellGraph) -> Findings:
    """Yield pairs of devices with links that touch in every posture; of two the one that is no arm, or comes later."""
    owners = {link.name: device for device in graph.cell.devices for link in device.description.links}
    reported: set[tuple[str, str]] = set()
    for contact in motion_answer(graph).rigid:
        one, other = owners.get(contact.first), owners.get(contact.second)
        if one is None or other is None or one is other:
            continue
        wrong, right = sorted((one, other), key=lambda device: _doubt(graph, device))
        if (wrong.name, right.name) in reported:
            continue
        reported.add((wrong.name, right.name))
        message = f"`{wrong.name}` must be outside of `{right.name}`, but `{contact.first}` and `{contact.second}`"
        related = (Related("the other device", graph.cell.locate(*right.path, "mount")),)
        yield found(graph, (*wrong.path, "mount"), f"{message} touch in every pose", related=related)


def _doubt(graph: CellGraph, device: Device) -> tuple[int, int]:
    """Order the devices by how likely their mount is the wrong one: cameras first, arms last, later before earlier."""
    kinds = {"camera": 0, "gripper": 1, "arm": 2}
    return kinds.get(device.kind, 1), -graph.cell.devices.index(device)
