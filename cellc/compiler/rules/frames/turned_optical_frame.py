"""An optical frame of a camera does not look along its z axis.

In an optical frame z points into the scene, x to the right and y down, which in the camera's own frame is x forward, y
left, z up. A description whose optical frame is not turned sends every detected part a quarter turn beside the camera.

Example that is reported:

```yaml
devices:
  side_camera:
    model: ./turned_camera  # expect at model
    mount: {parent: world, xyz: 1 0 1 m, rpy: 0 0 180 deg, calibration: side}
    revision: C
    firmware: sensor 5.16.0
    stamp: {source: driver, clock: ros}
calibrations:
  side: {revision: 1, measured: 2026-07-02, method: charuco, samples: 40, residual: 0.8 mm, owner: perception}
```

Example that is accepted:

```yaml
devices:
  side_camera:
    model: ./demo_camera
    mount: {parent: world, xyz: 1 0 1 m, rpy: 0 0 180 deg, calibration: side}
    revision: C
    firmware: sensor 5.16.0
    driver: demo_camera_driver 4.58.3
    description: demo_camera_description 4.58.3
    stamp: {source: driver, clock: ros}
calibrations:
  side: {revision: 1, measured: 2026-07-02, method: charuco, samples: 40, residual: 0.8 mm, owner: perception}
```

Fix: turn the joint of the optical frame by rpy -90 0 -90 deg against the camera's frame.

Source:

- https://www.ros.org/reps/rep-0103.html (as of 2025-10-24): suffix frames have z forward, x right, y down
- docs/principles.md#direction-and-scale
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Pose, identity

_COS_10_DEG = 0.985  # the calibrated mount of an imager is off by a few degrees at most


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield optical frames whose axes, seen from the root link of their device, are not those of REP-103."""
    for device in graph.cell.devices:
        for name in device.optical_frames:
            pose = _pose_in(graph, device.frames[name], device.root_link)
            if pose is not None and not _looks_forward(pose):
                message = f"the axes of `{device.name}/{name}` must be x right, y down, z forward"
                advice = "turn its joint by rpy `-90 0 -90 deg` against the camera's own frame"
                yield found(graph, (*device.path, "model"), message, advice)


def _pose_in(graph: CellGraph, name: str, root: str) -> Pose | None:
    pose = identity()
    for frame in graph.frames.chain(name):
        if frame.name == root:
            return pose
        if frame.transform_to_parent is None:
            return None
        pose = frame.transform_to_parent @ pose
    return None


def _looks_forward(pose: Pose) -> bool:
    turn = Pose((0.0, 0.0, 0.0), pose.quaternion)
    forward, right = turn.apply((0.0, 0.0, 1.0)), turn.apply((1.0, 0.0, 0.0))
    return forward[0] > _COS_10_DEG and -right[1] > _COS_10_DEG
