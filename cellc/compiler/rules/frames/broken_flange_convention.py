"""The flange and the tool frame of an arm do not follow the convention.

`flange` leaves the arm along x; `tool0` has the same origin and leaves it along z. Tools, cameras and goals are mounted
and written against these axes: on an arm that turns them, every gripper points sideways.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./turned_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./bare_arm_with_tool, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: turn the joint of `tool0` by rpy `90 0 90 deg` against `flange`; a tool's length belongs into a frame of its own.

Source: https://gavanderhoorn.github.io/rep/rep-0199.html
(draft of 2019-01-11): X+ of flange and Z+ of tool0 point away from the last link
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Pose, identity

_APART_M = 1e-3
_ALONG = 0.999  # cosine; figures of descriptions are rounded


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield devices with both frames whose z of tool0 is not x of flange, or whose origins differ."""
    for device in graph.cell.devices:
        flange, tool = device.frames.get("flange"), device.frames.get("tool0")
        if flange is None or tool is None:
            continue
        pose = _pose_in(graph, tool, flange)
        if pose is None or not _by_convention(pose):
            message = f"`tool0` of `{device.name}` must have the origin of `flange` and its z axis along x of `flange`"
            yield found(graph, (*device.path, "model"), message)


def _pose_in(graph: CellGraph, name: str, ancestor: str) -> Pose | None:
    pose = identity()
    for frame in graph.frames.chain(name):
        if frame.name == ancestor:
            return pose
        if frame.transform_to_parent is None or frame.moving:
            return None
        pose = frame.transform_to_parent @ pose
    return None


def _by_convention(pose: Pose) -> bool:
    out = Pose((0.0, 0.0, 0.0), pose.quaternion).apply((0.0, 0.0, 1.0))
    return math.hypot(*pose.position) < _APART_M and out[0] > _ALONG
