"""The tip of a group lies within the tool, or far from its end.

The tip is what goals place. With meters written as millimeters, or a lost sign, it lies in the flange: the arm brings
its flange to where the fingers were meant to be.

Example that is reported:

```yaml
frames:
  tcp: {parent: gripper/base, xyz: 0 0 0.162 mm, calibration: tcp}  # expect at tcp
motion: {goals: null}
rehearsals: null
```

Example that is accepted:

```yaml
frames:
  tcp: {parent: gripper/base, xyz: 0 0 162 mm, calibration: tcp}
```

Fix: measure the tip from the frame that it hangs on, and write its unit.

Source: docs/principles.md#direction-and-scale
"""

from __future__ import annotations

import math

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.motion import CartesianGoal
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.transforms import Vector3

_SHORTEST_M = 0.05
"""A shorter tool tells nothing."""
_NEAREST = 0.5
_BEYOND_M = 0.3


@rule(Severity.WARNING, assumes=("frame-cycle", "implausible-distance", "tip-off-the-tool-chain"))
def check(graph: CellGraph) -> Findings:
    """Yield tips less than half way to the fingers of the carried gripper, or far beyond them.

    A link of the arm may well be a tip, where its goals keep the distance themselves.
    """
    for group in graph.cell.groups:
        tip = graph.frames.get(group.tip_frame)
        arm = next((device for device in graph.cell.devices if group.base_link in _links(device)), None)
        if tip is None or arm is None or arm.tool_frame is None:
            continue
        pose = graph.frames.pose_in(tip.name, arm.tool_frame)
        end = _end(graph, arm)
        if pose is None or end is None or (reach_m := math.hypot(*end)) < _SHORTEST_M:
            continue
        along_m = sum(a * b for a, b in zip(pose.position, end, strict=True)) / reach_m
        if not _NEAREST * reach_m <= along_m <= reach_m + _BEYOND_M:
            message = f"tip `{tip.name}` must lie near the end of the tool, {reach_m * 1e3:.0f} mm or more from"
            message += f" `{arm.tool_frame}`, got {along_m * 1e3:.3g} mm towards it"
            if tip.kind is FrameKind.FIXED:
                yield found(graph, tip.path, message, related=(Related("the group", group.span),))
            elif tip.name in _links(arm) and (near := _nearest(graph, group.name, _NEAREST * reach_m)) is not None:
                related = (Related(f"goal `{near.name}` keeps no distance", near.span),)
                yield found(graph, (*group.path, "tip"), message, related=related)


def _nearest(graph: CellGraph, group: str, within_m: float) -> CartesianGoal | None:
    """Return the first goal of a group that brings its tip nearer to the goal's frame than a distance."""
    own = (goal for goal in graph.cell.goals if goal.group == group)
    return next((goal for goal in own if math.hypot(*goal.transform_tip_to_frame.position) < within_m), None)


def _links(device: Device) -> set[str]:
    return {link.name for link in device.description.links}


def _end(graph: CellGraph, arm: Device) -> Vector3 | None:
    """Return the origin of the farthest link of the only gripper that an arm carries, in its tool frame, m."""
    grippers = [tool for name in arm.carries if (tool := graph.cell.device(name)).kind == "gripper"]
    if len(grippers) != 1:
        return None
    poses = [graph.frames.pose_in(link.name, arm.tool_frame or "") for link in grippers[0].description.links]
    places = [pose.position for pose in poses if pose is not None]
    return max(places, key=lambda place: math.hypot(*place), default=None)
