"""Rules on what is around an arm: what planning does not know of is hit at full speed."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

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
        yield found(graph, (*base.path, "mount"), f"{message} to {names}")
