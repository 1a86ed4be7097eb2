"""The angles of a camera on a wrist are written from yaw to roll.

`static_transform_publisher` takes yaw, pitch and roll, and `tf2_echo` prints roll, pitch and yaw; a spec and a URDF
take roll first. A camera beside a tool is tilted towards it or away from it, and not sideways: where it is, and the
same angles from the last to the first would not be, they were most likely copied in the other order.

Example that is reported:

```yaml
devices:
  camera: {mount: {parent: arm/tool0, xyz: 0 -70 30 mm, rpy: -90 -75 0 deg, calibration: hand_eye}}  # expect at rpy
```

Example that is accepted:

```yaml
devices:
  camera: {mount: {parent: arm/tool0, xyz: 0 -70 30 mm, rpy: 0 -75 -90 deg, calibration: hand_eye}}
```

Fix: write roll, pitch and yaw in this order, about the fixed axes of the parent.

Source: https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Tf2/Writing-A-Tf2-Static-Broadcaster-Py.html (Jazzy):
static_transform_publisher takes yaw first
"""

from __future__ import annotations

import math

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Pose, from_xyz_rpy, identity

_SIDEWAYS_RAD = math.radians(8.0)
"""What brackets and calibrations turn a camera out of the plane of its tool, at most."""
_STRAIGHT_RAD = math.radians(2.0)
_BESIDE_M = 0.02
"""Nearer to the axis of the tool no direction is away from it."""


@rule(Severity.WARNING, assumes=("turned-optical-frame",))
def check(graph: CellGraph) -> Findings:
    """Yield cameras on a tool flange that look sideways, and would not with their angles in the reverse order."""
    tools = {device.tool_frame for device in graph.cell.devices}
    for device in graph.cell.devices:
        for name in device.optical_frames:
            chain = graph.frames.chain(device.frames[name])
            place = next((frame for frame in chain if frame.name == device.root_link), None)
            if place is None or place.parent not in tools or place.transform_to_parent is None:
                continue
            mount, inside = place.transform_to_parent, _inside(graph, device, name)
            roll, pitch, yaw = mount.rpy()
            turned = from_xyz_rpy(mount.position, (yaw, pitch, roll))
            sideways = _sideways(mount, inside)
            if sideways > _SIDEWAYS_RAD and _sideways(turned, inside) < _STRAIGHT_RAD:
                degrees = math.degrees(sideways)
                message = f"`{device.name}` looks {degrees:.0f} deg sideways past its tool; with `rpy` in the reverse"
                yield found(graph, (*device.path, "mount", "rpy"), f"{message} order it would look along it")
                break


def _inside(graph: CellGraph, device: Device, name: str) -> Pose:
    """Return the pose of an optical frame in the root link of its camera."""
    pose = identity()
    for frame in graph.frames.chain(device.frames[name]):
        if frame.name == device.root_link:
            break
        pose = (frame.transform_to_parent or identity()) @ pose
    return pose


def _sideways(mount: Pose, inside: Pose) -> float:
    """Return by how much a camera looks out of the plane through itself and the axis of its tool, z, in radians."""
    x, y, _ = mount.position
    beside = math.hypot(x, y)
    if beside < _BESIDE_M:
        return 0.0
    forward = Pose((0.0, 0.0, 0.0), (mount @ inside).quaternion).apply((0.0, 0.0, 1.0))
    return abs(math.asin(max(-1.0, min(1.0, (forward[1] * x - forward[0] * y) / beside))))
