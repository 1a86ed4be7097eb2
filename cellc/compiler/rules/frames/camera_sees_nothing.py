"""A fixed camera sees nothing of the cell.

Turned by half a turn, or mounted from a calibration that was inverted, it shows the ceiling or the wall. Its images
arrive, its node detects nothing, and a watcher of the area reports forever that it is empty.

Example that is reported:

```yaml
# a cell of two cameras
devices: {second: {mount: {rpy: 0 -90 0 deg}}}  # expect at mount
```

Example that is accepted:

```yaml
# a cell of two cameras
devices: {second: {mount: {rpy: 0 90 0 deg}}}
```

Fix: correct the mount; its z axis is up and x is where the body looks, and the optical frame follows from them.

Source: docs/principles.md#direction-and-scale
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from cellc.compiler.cell.device import CameraStream
from cellc.compiler.cell.frame import FrameKind, SceneBox
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Pose, Vector3

_SLACK_RAD = math.radians(15.0)
"""A thing may be this far outside the view: one point represents all of it."""
_PLACED = (FrameKind.FIXED, FrameKind.SCENE, FrameKind.DYNAMIC)


@rule(Severity.WARNING, assumes=("frame-cycle", "implausible-distance", "detached-mount", "turned-optical-frame"))
def check(graph: CellGraph) -> Findings:
    """Yield cameras that no joint moves and that have no frame, box or device before them, where there are places."""
    for device in graph.cell.devices:
        streams = () if device.camera is None else device.camera.streams
        eyes = [(stream, graph.frames.in_world(stream.frame)) for stream in streams]
        if not eyes:
            continue
        things = list(_places(graph, _PLACED)) + [corner for box in graph.cell.scene for corner in _corners(graph, box)]
        seen = [*things, *_places(graph, (FrameKind.MOUNT,), device.name)]
        known = [(stream, eye) for stream, eye in eyes if eye is not None]
        if not things or not known or any(_sees(stream, eye, thing) for stream, eye in known for thing in seen):
            continue
        nearest = min(things, key=lambda thing: _aside(known[0][1], thing))
        aside_deg = math.degrees(_aside(known[0][1], nearest))
        message = f"`{device.name}` must look at something of the cell, and the nearest lies {aside_deg:.0f} deg"
        yield found(graph, (*device.path, "mount"), f"{message} beside its axis")


def _places(graph: CellGraph, kinds: tuple[FrameKind, ...], but_of: str = "") -> Iterator[Vector3]:
    """Yield where frames of some kinds stand in the world, m, as far as no joint moves them."""
    for frame in graph.cell.frames:
        place = graph.frames.in_world(frame.name) if frame.kind in kinds and frame.device != but_of else None
        if place is not None:
            yield place.position


def _corners(graph: CellGraph, box: SceneBox) -> Iterator[Vector3]:
    """Yield corners, middles of edges and sides, and the center of a box in the world."""
    parent = graph.frames.in_world(box.parent)
    if parent is None:
        return
    center = parent @ box.transform_to_parent
    for signs in itertools.product((-0.5, 0.0, 0.5), repeat=3):
        x, y, z = (sign * length for sign, length in zip(signs, box.size, strict=True))
        yield (center @ Pose((x, y, z), (0.0, 0.0, 0.0, 1.0))).position


def _sees(stream: CameraStream, eye: Pose, thing: Vector3) -> bool:
    x, y, z = _before(eye, thing)
    if z <= 0.0 or stream.view is None:
        return z > 0.0
    aside, above = math.atan2(abs(x), z), math.atan2(abs(y), z)
    within = aside <= stream.view.horizontal / 2 + _SLACK_RAD and above <= stream.view.vertical / 2 + _SLACK_RAD
    return within and math.hypot(x, y, z) <= stream.view.farthest_m


def _before(eye: Pose, thing: Vector3) -> Vector3:
    return (eye.inverse() @ Pose(thing, (0.0, 0.0, 0.0, 1.0))).position


def _aside(eye: Pose, thing: Vector3) -> float:
    """Return the angle between the axis of a camera and a place, rad."""
    x, y, z = _before(eye, thing)
    return math.atan2(math.hypot(x, y), z)
