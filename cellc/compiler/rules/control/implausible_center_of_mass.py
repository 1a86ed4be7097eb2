"""The center of mass of a payload cannot be that of the tool.

The arm compensates the weight of a load at the stated center of the load. With meters read as millimeters, or an axis
swapped, it pushes against nothing, drifts, or stops protectively as soon as a person guides it.

Example that is reported:

```yaml
devices: {arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 0.058 mm}}}  # expect at center_of_mass
```

Example that is accepted:

```yaml
devices: {arm: {payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm}}}
```

Fix: measure it in the frame of the flange, z out of the arm, and write its unit.

Source: docs/principles.md#payload
"""

from __future__ import annotations

import math

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.robot import Payload
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_IN_THE_FLANGE_M = 0.005
_LONG_M = 0.05
"""A tool that reaches further than this has its center of mass outside of the flange."""
_BEYOND_M = 0.05
"""A part that is held has its center of mass beyond the end of the tool by at most as much."""


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield centers of mass in the flange, behind it, or beyond the end of what the arm carries."""
    for device in graph.cell.devices:
        payload, reach_m = device.payload, _reach_m(graph, device)
        if payload is None or reach_m <= 0.0:
            continue
        wrong = _wrong(payload, reach_m)
        if wrong:
            path = (*device.path, "payload", "center_of_mass")
            message = f"the center of mass of the payload of `{device.name}` must lie between the flange and"
            message += f" {(reach_m + _BEYOND_M) * 1e3:.0f} mm from it, got {graph.cell.text(*path)}, {wrong}"
            related = tuple(Related("carried here", graph.cell.device(name).span) for name in device.carries)
            yield found(graph, path, message, related=related)


def _wrong(payload: Payload, reach_m: float) -> str:
    far_m = math.hypot(*payload.center_of_mass)
    if far_m > reach_m + _BEYOND_M:
        return "beyond the end of the tools"
    if payload.center_of_mass[2] < -_IN_THE_FLANGE_M and reach_m > _LONG_M:
        return "behind the flange"
    return "within the flange" if far_m < _IN_THE_FLANGE_M and reach_m > _LONG_M else ""


def _reach_m(graph: CellGraph, arm: Device) -> float:
    """Return how far the links of what an arm carries reach from its tool frame, 0 where that is not known."""
    links = (link.name for name in arm.carries for link in graph.cell.device(name).description.links)
    poses = [graph.frames.pose_in(name, arm.tool_frame or "") for name in links]
    return max((math.hypot(*pose.position) for pose in poses if pose is not None), default=0.0)
