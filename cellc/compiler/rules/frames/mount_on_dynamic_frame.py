"""A device hangs on a frame that a node publishes, and the robot description has no joint that moves so.

The description is one tree of links whose joints are fixed or controlled; a frame that a node sends to /tf is not
in it. robot_state_publisher, MoveIt and the controller manager refuse a description whose parent link is missing, and
goals of an arm on it would be planned as if its base were fixed.

Example that is reported:

```yaml
frames:
  cart:
    parent: world
    dynamic: true
    published_by: perception
    rate: 10 Hz
    buffer: 10 s
    simulated_pose: {parent: world}
devices:
  arm: {mount: {parent: cart}}  # expect at parent
```

Example that is accepted:

```yaml
devices:
  arm: {mount: {parent: world, xyz: 0 0 0.8 m}}
```

Fix: mount it on the world, a device or a static frame.

Source: https://github.com/ros/urdfdom_headers (1.1.1): urdf_model/model.h refuses a joint whose parent link is missing
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("frame-cycle",))
def check(graph: CellGraph) -> Findings:
    """Yield devices with a published frame between them and the next link or the world."""
    for device in graph.cell.devices:
        for frame in graph.frames.chain(device.parent_frame):
            if frame.kind in (FrameKind.LINK, FrameKind.MOUNT):
                break
            if frame.kind is FrameKind.DYNAMIC:
                message = f"`{device.name}` must be mounted on what the robot description has, got `{frame.name}`"
                path = (*device.path, "mount", "parent")
                yield found(graph, path, f"{message}, which `{frame.authority}` publishes")
