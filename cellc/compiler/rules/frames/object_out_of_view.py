"""A camera does not look at what it is to detect.

From the detection pose of the arm, the object lies beside or behind the image. A hand-eye result
that was inverted, applied twice or written under another parent shows here, as does an overhead camera that looks up.

Example that is reported:

```yaml
devices:
  camera: {mount: {parent: arm/tool0, xyz: 0 -70 30 mm, rpy: 0 105 -90 deg, calibration: hand_eye}}  # expect at mount
```

Example that is accepted:

```yaml
devices:
  camera: {mount: {parent: arm/tool0, xyz: 0 -70 30 mm, rpy: 0 -75 -90 deg, calibration: hand_eye}}
```

Fix: check direction, order of angles and parent of the mount, or detect from a pose that sees the object.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

import math

from cellc.compiler.cell.device import Device, FieldOfView
from cellc.compiler.feasibility import ViewAnswer, motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_SLACK_RAD = math.radians(15.0)
"""A real object lies somewhere near where the mock has it."""


@rule(Severity.WARNING, assumes=(*KNOWN_GOALS, "detached-mount"))
def check(graph: CellGraph) -> Findings:
    """Yield objects that are out of the field of view, or out of the distances, of their camera, one for an object."""
    frames = {frame.name: frame for frame in graph.cell.frames}
    reported: set[str] = set()
    for view in motion_answer(graph).views:
        camera = next(device for device in graph.cell.devices if view.camera_frame in device.frames.values())
        wrong = _wrong(view, _field(camera, view.camera_frame))
        if wrong and view.name not in reported:
            reported.add(view.name)
            where = f"in `{view.posture}`" if view.posture else "at the start"
            message = f"`{camera.name}` must see `{view.name}` {where}, where it is detected, but it lies {wrong}"
            related = (Related("what is detected", frames[view.name].span),)
            yield found(graph, (*camera.path, "mount"), message, related=related)


def _field(camera: Device, frame: str) -> FieldOfView | None:
    streams = () if camera.camera is None else camera.camera.streams
    return next((stream.view for stream in streams if stream.frame == frame), None)


def _wrong(view: ViewAnswer, field: FieldOfView | None) -> str:
    """Say where an object lies that is not seen; empty where it is seen. Without a field it must lie in front."""
    x, y, z = view.place
    if z <= 0.0:
        return f"{abs(z):.3g} m behind the camera"
    if field is None:
        return ""
    aside, above = math.atan2(abs(x), z), math.atan2(abs(y), z)
    if aside > field.horizontal / 2 + _SLACK_RAD or above > field.vertical / 2 + _SLACK_RAD:
        figures = f"{math.degrees(aside):.0f} deg to the side and {math.degrees(above):.0f} deg above or below the axis"
        return f"{figures} of a view of {math.degrees(field.horizontal):.0f} by {math.degrees(field.vertical):.0f} deg"
    distance = math.hypot(x, y, z)
    if not field.nearest_m <= distance <= field.farthest_m:
        return f"{distance:.3g} m away, which is not between {field.nearest_m:g} m and {field.farthest_m:g} m"
    return ""
