"""Rules on what arms stand on, what hangs on them, and on which side of a flange a tool is."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Solid
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.transforms import Vector3

_UPRIGHT = 0.985
"""Cosine of 10 deg: what hangs on a wall or from a ceiling is carried from another side."""
_WITHIN_M = 0.03
"""A foot is on what reaches this far to each side of it: arms stand on plates of 0.1 m and more."""
_SUNK_M, _GAP_M, _BASE_M = 0.005, 0.1, 0.1
"""An arm may be sunk into a plate a little; what begins within the height of its base cuts it."""
_SUPPORT = re.compile(r"pedest|stand|column|post|plinth|socket|base|support|riser|podest|mount", re.IGNORECASE)


@rule(Severity.WARNING, assumes=("frame-cycle", "implausible-distance", "implausible-size"))
def foot_off_its_support(graph: CellGraph) -> Findings:
    """Yield things of the scene that an arm is in, and supports that end far below one."""
    for arm, foot in _feet(graph):
        under = [(box, top) for box in graph.cell.scene for top in _top_over(graph, box, foot)]
        for box, top in under:
            if top > _SUNK_M:
                message = f"`{box.name}` must end at the foot of `{arm.name}`, got {top * 1e3:.3g} mm above it"
                yield found(graph, box.path, message, related=_mounted(graph, arm))
        highest = max((top for _, top in under), default=0.0)
        for box, top in under:
            if top == highest < -_GAP_M and (_SUPPORT.search(box.name) or _is_support(graph, box)):
                message = f"`{box.name}` must carry `{arm.name}`, got {-top * 1e3:.3g} mm between it and the foot"
                yield found(graph, box.path, message, related=_mounted(graph, arm))


def _is_support(graph: CellGraph, box: Solid) -> bool:
    return box.name in graph.cell.surroundings.support.shapes


def _mounted(graph: CellGraph, arm: Device) -> tuple[Related, ...]:
    return (Related(f"`{arm.name}` is mounted here", graph.cell.locate(*arm.path, "mount")),)


def _feet(graph: CellGraph) -> Iterator[tuple[Device, Vector3]]:
    """Yield the arms that stand upright on what no device carries, with the place of their foot in the world."""
    carried = {name for device in graph.cell.devices for name in device.mount.carries}
    for device in graph.cell.devices:
        pose = graph.frames.in_world(device.body.root_link) if device.kind == "arm" else None
        upright = pose is not None and pose.apply((0.0, 0.0, 1.0))[2] - pose.position[2] > _UPRIGHT
        if pose is not None and upright and device.name not in carried:
            yield device, pose.position


def _top_over(graph: CellGraph, box: Solid, foot: Vector3) -> Iterator[float]:
    """Yield by how much an upright box under a foot, around it or in the base ends above the foot, m."""
    parent = graph.frames.in_world(box.parent)
    if parent is None or box.shape is not None or box.is_plane:
        return
    pose = parent @ box.transform_to_parent
    if pose.apply((0.0, 0.0, 1.0))[2] - pose.position[2] < _UPRIGHT:
        return
    x, y, z = pose.inverse().apply(foot)
    wide, deep, high = box.size
    if abs(x) < wide / 2.0 - _WITHIN_M and abs(y) < deep / 2.0 - _WITHIN_M and z > -high / 2.0 - _BASE_M:
        yield high / 2.0 - z


_APART_M = 0.3
"""What a link carries begins at most this far from it."""


@rule(Severity.WARNING, assumes=("frame-cycle", "implausible-size"))
def thing_apart_from_its_link(graph: CellGraph) -> Findings:
    """Yield things of the scene that move with a link of an arm which is nowhere near them."""
    for box in graph.cell.scene:
        depth = box.depth_m((0.0, 0.0, 0.0)) if any(frame.moving for frame in graph.frames.chain(box.parent)) else None
        if depth is not None and depth < -_APART_M:
            message = f"`{box.name}` moves with `{box.parent}` and must begin within {_APART_M:g} m of it,"
            related = enters(graph, "it is placed here", box.path)
            yield found(graph, (*box.path, "parent"), f"{message} got {-depth:.3g} m", related=related)


_BEHIND_M = 0.002
_TOOLS = ("gripper", "hand", "sensor", "digital")


@rule(Severity.WARNING, assumes=("frame-cycle", "mounted-against-vendor"))
def tool_behind_the_flange(graph: CellGraph) -> Findings:
    """Yield tools whose root lies behind the frame where tools mount, which looks out of the flange along z."""
    mounts = {device.body.tool_frame: device for device in graph.cell.devices if device.kind == "arm"}
    for device in graph.cell.devices:
        arm, z = mounts.get(device.mount.parent_frame), device.mount.transform_root_to_parent.position[2]
        if arm is not None and device.kind in _TOOLS and z < -_BEHIND_M:
            message = f"`{device.name}` must be before `{device.mount.parent_frame}` of `{arm.name}`, or at it, got"
            yield found(graph, (*device.path, "mount"), f"{message} {-z * 1e3:.3g} mm behind it")
