"""What several rules ask of tools and parts, each answered once for a cell."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.grips import gripped_parts
from cellc.compiler.rules.kit import CellGraph, YamlPath
from cellc.contract.transforms import Vector3


def farthest_link(graph: CellGraph, arm: Device) -> Vector3 | None:
    """Return where the farthest link of what an arm carries is, in its tool frame, m; None where that is not known."""
    return graph.once(_farthest).get(arm.name)


def _farthest(graph: CellGraph) -> Mapping[str, Vector3]:
    farthest: dict[str, Vector3] = {}
    for arm in graph.cell.devices:
        tool = arm.body.tool_frame or ""
        links = (link.name for name in arm.mount.carries for link in graph.cell.device(name).body.description.links)
        places = [pose.position for name in links if (pose := graph.frames.pose_in(name, tool)) is not None]
        if places:
            farthest[arm.name] = max(places, key=lambda place: math.hypot(*place))
    return farthest


def parts_taken(graph: CellGraph) -> Mapping[YamlPath, str]:
    """Return the frame of the part that each closing step takes, by the place of the step."""
    return gripped_parts(graph.cell, graph.frames)
