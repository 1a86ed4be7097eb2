"""A joint cannot hold what hangs on it.

Gravity alone asks for more than the joint can give, with the tool and the payload, in a pose or at a goal of the cell.
The arm does not get there, or sinks as it does: a planner that knows no dynamics sends it all the same.

Example that is reported:

```xml
<!-- expect at devices.stage -->
<link name="carriage">
  <inertial><mass value="40"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
</link>
```

Example that is accepted:

```xml
<link name="carriage">
  <inertial><mass value="0.8"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
</link>
```

Fix: carry less, choose poses nearer to the axis, or correct masses, payload and limits of effort.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import HoldingAnswer, motion_answer
from cellc.compiler.rules.geometry import KNOWN_POSES
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule


@rule(Severity.WARNING, assumes=(*KNOWN_POSES, "negative-mass", "payload-above-limit"))
def check(graph: CellGraph) -> Findings:
    """Yield joints that must hold more than their limit of effort, each where it is worst."""
    owners = {joint.name: (device, joint) for device in graph.cell.devices for joint in device.joints}
    for held in motion_answer(graph).holding:
        device, joint = owners[held.joint]
        if joint.effort is None or held.effort <= joint.effort:
            continue
        path = (*device.path, "payload", "mass") if device.payload is not None else device.path
        unit = "N" if joint.type == "prismatic" else "Nm"
        where = f"in `{held.posture}`" if held.posture else "where the cell begins"
        message = f"`{held.joint}` can give {joint.effort:g} {unit} and must hold {held.effort:.3g} {unit} {where}"
        related = tuple(Related("the worst place", graph.cell.locate(*place)) for place in _places(graph, held))
        yield found(graph, path, message, related=related)


def _places(graph: CellGraph, held: HoldingAnswer) -> list[YamlPath]:
    posed = [*graph.cell.poses, *graph.cell.goals]
    return [posture.path for posture in posed if posture.name == held.posture][:1]
