"""Rules on what is around an arm: what planning does not know of is hit at full speed."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.commissioning import chain_of
from cellc.compiler.rules.geometry import placed_by
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.contract.transforms import Vector3

_CARRIED_M = 0.05
"""An arm is on what ends this near to its root: a plate, or feet, may be between."""


@rule(Severity.BLOCKER, assumes=("frame-cycle", "detached-mount"))
def missing_surroundings(graph: CellGraph) -> Findings:
    """Yield what is not stated around the arms, in one finding, and each arm that nothing stated carries."""
    arms = [device for device in graph.cell.devices if device.kind == "arm"]
    around = graph.cell.surroundings
    missing = [f"`{part}`" for part, known in around if not known.is_stated or (part == "support" and known.none)]
    if arms and missing:
        names = " and ".join(f"`{arm.name}`" for arm in arms)
        message = f"it is not stated what is around {names} within reach: {', '.join(missing)}"
        yield found(graph, ("surroundings",), message, related=tuple(_mounts(graph, arms)))
    for arm in arms if around.support.shapes and around.support.open is None else ():
        yield from _in_the_air(graph, arm)


def _mounts(graph: CellGraph, arms: list[Device]) -> Iterator[Related]:
    for arm in arms:
        yield Related(f"`{arm.name}` is mounted here", graph.cell.locate(*arm.path, "mount"))


def _in_the_air(graph: CellGraph, arm: Device) -> Findings:
    """Yield an arm whose mount no stated support meets; what carries a rail carries the arm on it."""
    carrier = {name: device for device in graph.cell.devices for name in device.mount.carries}
    base = arm
    while base.name in carrier:
        base = carrier[base.name]
    root = graph.frames.in_world(base.body.root_link)
    gaps: list[float] = []
    for solid in graph.cell.scene if root is not None else ():
        parent = graph.frames.in_world(solid.parent)
        if solid.name not in graph.cell.surroundings.support.shapes or parent is None or root is None:
            continue
        depth = solid.depth_m(parent.inverse().apply(root.position))
        gaps.append(0.0 if depth is None else -depth)
    if gaps and min(gaps) > _CARRIED_M:
        names = " and ".join(f"`{name}`" for name in graph.cell.surroundings.support.shapes)
        message = f"`{base.name}` must be within {_CARRIED_M * 1e3:g} mm of its support, got {min(gaps) * 1e3:.0f} mm"
        supports = (solid for solid in graph.cell.scene if solid.name in graph.cell.surroundings.support.shapes)
        related = tuple(Related(f"`{solid.name}` is placed here", solid.span) for solid in supports)
        yield found(graph, (*base.path, "mount"), f"{message} to {names}", related=related)


_STRETCHED = 0.85
"""Share of the straightened chain from base to tip that an arm reaches in any direction, offsets left out."""
_ON_THE_FLOOR_M = 0.3
"""What is as high and carries an arm is no plate: it ends on the floor; and so high above it is the world's origin."""
_LENGTH = re.compile(r"(\d+(?:\.\d+)?)\s*(mm|cm|m)\b")
_METERS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}


@rule(Severity.WARNING, assumes=("frame-cycle", "detached-mount", "group-without-joints"))
def surroundings_within_reach(graph: CellGraph) -> Findings:
    """Yield surroundings that are said to be out of reach, and that an arm reaches by its chain and its mount."""
    arms = {link.name: arm for arm in graph.cell.devices for link in arm.body.description.links if arm.kind == "arm"}
    reached: dict[str, tuple[Device, float]] = {}
    for group in graph.cell.groups:
        arm = arms.get(group.base_link)
        if arm is not None:
            reached[arm.name] = (
                arm,
                max(_STRETCHED * chain_of(graph, group).length, reached.get(arm.name, (arm, 0.0))[1]),
            )
    for part, known in graph.cell.surroundings:
        path: YamlPath = ("surroundings", part, "none")
        lengths = [float(number) * _METERS[unit] for number, unit in _LENGTH.findall(known.none or "")]
        for arm, reach_m in reached.values() if known.none else ():
            below_m = _floor_below_m(graph, arm) if part == "floor" else None
            away_m = max(lengths) if lengths else below_m
            if away_m is not None and away_m < reach_m:
                where = "below its base" if not lengths else "away by the reason"
                message = f"`{part}` must be beyond the {reach_m * 1e3:.0f} mm that `{arm.name}` reaches, got"
                tips = (group.tip_frame for group in graph.cell.groups if arms.get(group.base_link) is arm)
                related: tuple[Related, ...] = (
                    Related(f"`{arm.name}` is mounted here", graph.cell.locate(*arm.path, "mount")),
                )
                related += placed_by(graph, *tips)
                yield found(graph, path, f"{message} {away_m * 1e3:.0f} mm {where}", related=related)
                break


def _floor_below_m(graph: CellGraph, arm: Device) -> float | None:
    """Return how far the floor is below the root of an arm; None where nothing tells.

    The floor is where a support ends that is no plate, and else at the origin of the world where the arm is well above.
    """
    root = graph.frames.in_world(arm.body.root_link)
    if root is None:
        return None
    height_m = root.position[2]
    ends = [0.0] if height_m >= _ON_THE_FLOOR_M else []
    for solid in graph.cell.scene:
        parent = graph.frames.in_world(solid.parent)
        if solid.name in graph.cell.surroundings.support.shapes and parent is not None and any(solid.size):
            place = parent @ solid.transform_to_parent @ solid.center
            corners = [place.apply(corner)[2] for corner in _corners(solid.size)]
            if max(corners) - min(corners) >= _ON_THE_FLOOR_M and place.position[2] < height_m:
                ends.append(min(corners))
    below = [height_m - end for end in ends if end < height_m]
    return min(below, default=None)


def _corners(size: Vector3) -> list[Vector3]:
    x, y, z = (edge / 2.0 for edge in size)
    return [(a * x, b * y, c * z) for a in (-1.0, 1.0) for b in (-1.0, 1.0) for c in (-1.0, 1.0)]
