"""A tool is mounted otherwise than its vendor hangs it on this arm.

Where arm and tool are of one vendor, screws and pins leave one pose. A model in which the tool is turned or shifted
against it has its fingers across the real ones: goals are reached, and the fingers close beside the part or on it.

Example that is reported:

```yaml
devices:
  gripper: {mount: {parent: arm/tool0, xyz: 0 0 0 mm, rpy: 0 0 45 deg}}  # expect at mount
frames:
  tcp: {parent: gripper/base, rpy: 0 0 -45 deg}
```

Example that is accepted:

```yaml
devices:
  gripper: {mount: {parent: arm/tool0}}
```

Fix: mount it as the message says; with a plate between, mount it on a frame of the plate.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Vector3

_APART_M = 1e-3
_APART_RAD = math.radians(1.0)


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield devices whose pose on the frame that the vendor names is another than the vendor's."""
    for device in graph.cell.devices:
        for mount in device.vendor_mounts:
            for arm in graph.cell.devices:
                if arm.model != mount.model or arm.frames.get(mount.frame) != device.parent_frame:
                    continue
                off = mount.pose.inverse() @ device.transform_root_to_parent
                if math.hypot(*off.position) > _APART_M or math.hypot(*off.rotation_vector()) > _APART_RAD:
                    message = f"`{device.name}` must sit on `{arm.name}/{mount.frame}` as its vendor has it:"
                    message += f" xyz {_millimeters(mount.pose.position)} mm, rpy {_degrees(mount.pose.rpy())} deg"
                    yield found(graph, (*device.path, "mount"), message)


def _millimeters(position: Vector3) -> str:
    return " ".join(f"{round(value * 1e3, 3) + 0.0:g}" for value in position)


def _degrees(angles: Vector3) -> str:
    return " ".join(f"{round(math.degrees(angle), 3) + 0.0:g}" for angle in angles)
