"""The catalog and the vendor's own description do not agree.

Plans and checks are made with the kinematics and limits of the catalog, and the vendor's tools with those of the
package: where they differ, one of them is of another release, or of another robot. Compared are the frames of all links
that both have, with every joint at zero and with each a little off it, and the limits of all joints.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./bent_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A,  # expect at model
             firmware: bare 1.0.0}
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./vendored_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
```

Fix: put the release of the package beside the spec that the device is pinned to, or bring the robot as a folder.

Source: docs/principles.md#robot-descriptions
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.robot.description.model import Description, Joint
from cellc.robot.description.posture import posture

_LENGTH_M = 1e-5
"""By which frames may differ: vendors round the figures of their files."""
_ANGLE_RAD = 1e-4
_SHARE = 1e-3
_OFF_RAD_OR_M = 0.1


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield one finding for each device that differs, with the largest difference of each kind."""
    for device in graph.cell.devices:
        vendor = device.vendor_description
        if vendor is None or vendor.description is None:
            continue
        placed = filter(None, _placed(device, vendor.description))
        differences = [*placed, *_limited(device.description, vendor.description)]
        if differences:
            message = f"`{device.name}` differs from the description in `{vendor.folder}`: {'; '.join(differences)}"
            yield found(graph, (*device.path, "model"), message)


def _placed(device: Device, vendor: Description) -> Iterator[str]:
    """Yield how far a link is from where the vendor has it; the calibration of one robot is compared with nothing."""
    if device.kinematics is not None and device.kinematics.calibration is not None:
        return
    movable = [joint.name for joint in device.description.joints if joint.movable]
    for positions in ({}, {name: _OFF_RAD_OR_M * (number + 1) for number, name in enumerate(movable)}):
        ours, theirs = posture(device.description, positions), posture(vendor, positions)
        base = theirs.get(device.root_link)
        shared = [name for name in ours if name in theirs]
        if base is None or len(shared) < 2:
            yield f"it has no link `{device.root_link}`" if base is None else "no link is named alike"
            return
        apart = {name: ours[name].inverse() @ base.inverse() @ theirs[name] for name in shared}
        far = max(shared, key=lambda name: math.dist(apart[name].position, (0, 0, 0)))
        turned = max(shared, key=lambda name: math.dist(apart[name].rotation_vector(), (0, 0, 0)))
        length = math.dist(apart[far].position, (0, 0, 0))
        angle = math.dist(apart[turned].rotation_vector(), (0, 0, 0))
        if length > _LENGTH_M or angle > _ANGLE_RAD:
            yield f"`{far}` is {length * 1000:.3g} mm off" if length > _LENGTH_M else ""
            yield f"`{turned}` is turned by {math.degrees(angle):.3g} deg" if angle > _ANGLE_RAD else ""
            return


def _limited(ours: Description, vendor: Description) -> Iterator[str]:
    for joint in ours.joints:
        theirs = vendor.joint(joint.name) if joint.movable else None
        if theirs is not None:
            yield from _figures(joint, theirs)


def _figures(joint: Joint, theirs: Joint) -> Iterator[str]:
    if joint.limit is None or theirs.limit is None or joint.type != theirs.type:
        if joint.type != theirs.type:
            yield f"`{joint.name}` is {joint.type}, and {theirs.type} there"
        return
    for figure in ("lower", "upper", "velocity", "effort"):
        here, there = getattr(joint.limit, figure), getattr(theirs.limit, figure)
        if here is not None and there is not None and not math.isclose(here, there, rel_tol=_SHARE, abs_tol=_SHARE):
            yield f"{figure} of `{joint.name}` is {here:.6g}, and {there:.6g} there"
