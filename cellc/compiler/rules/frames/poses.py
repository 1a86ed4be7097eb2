"""Rules on the figures of a pose: unit, order and size."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from cellc.compiler.graph.neighbors import Neighbors
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.transforms import Pose, Vector3, from_xyz_rpy, identity

_LARGEST_CELL_M = 20.0


@rule(Severity.ERROR)
def implausible_distance(graph: CellGraph) -> Findings:
    """Yield frames more than 20 m from their parent, and from each frame beside them that is near.

    A hall of 120 m is a row of stations: each has a neighbor. A frame in the wrong unit has none.
    """
    placed: dict[str, dict[str, Vector3]] = {}
    for frame in graph.cell.frames:
        if frame.transform_to_parent is not None:
            placed.setdefault(frame.parent, {})[frame.name] = frame.transform_to_parent.position
    alone = {name for beside in placed.values() for name in _without_neighbor(beside)}
    for frame in graph.cell.frames if alone else ():
        if frame.name in alone:
            wanted = f"within {_LARGEST_CELL_M:g} m of `{frame.parent}`, or of another frame that is"
            distance = math.hypot(*placed[frame.parent][frame.name])
            yield found(graph, (*frame.path, "xyz"), f"`{frame.name}` must lie {wanted}, got {distance:g} m")


def _without_neighbor(beside: Mapping[str, Vector3]) -> list[str]:
    """Return the frames of one parent that no row of neighbors joins with its origin."""
    far = [(position, name) for name, position in beside.items() if math.hypot(*position) > _LARGEST_CELL_M]
    left = Neighbors(far, _LARGEST_CELL_M)
    alone = {name for _, name in far}
    reached = [position for name, position in beside.items() if name not in alone] if far else []
    while reached:
        joined = [neighbor for place in reached for neighbor in left.take(_LARGEST_CELL_M, of=place)]
        alone.difference_update(name for _, name in joined)
        reached = [place for place, _ in joined]
    return [name for _, name in far if name in alone]


_DEGREES = re.compile(r"[-+0-9.,\s]*\d\s*deg\s*")
_NUMBER = re.compile(r"\d+(?:\.(\d*))?")
_QUARTERS = tuple(math.pi * numerator / 2 for numerator in (1, 2, 3, 4))
_PARTS = (*_QUARTERS, *(math.pi * numerator / 12 for numerator in (2, 3, 4, 8, 9, 10)))
"""What programs print for 90, 180, 270 and 360 degrees, and for 30, 45, 60, 120, 135 and 150."""
_JOINTS = 4
"""As many positions are those of an arm; a rotation and a translation have three numbers."""


@rule(Severity.WARNING)
def radians_as_degrees(graph: CellGraph) -> Findings:
    """Yield values in degrees with a number that is a fraction of pi to its last digit, and arms that hardly turn."""
    for path, text in graph.cell.places.texts.items():
        why = _why(text) if _DEGREES.fullmatch(text) else None
        if why is not None:
            yield found(graph, path, f"`{path[-1]}` must be in degrees, got `{text}`, where {why}")


def _why(text: str) -> str | None:
    """Return what tells that numbers are radians; None where nothing does."""
    numbers = [(number[0], len(number[1] or "")) for number in _NUMBER.finditer(text)]
    for number, decimals in numbers:
        if _is_fraction(float(number), decimals):
            return f"{number} is {math.degrees(float(number)):.0f} deg in radians"
    printed = sum(decimals > 1 for _, decimals in numbers)
    if len(numbers) >= _JOINTS and printed > 1 and all(float(number) <= math.tau for number, _ in numbers):
        return f"{len(numbers)} joints are within {math.tau:.2f} of zero, as positions in radians do"
    return None


def _is_fraction(number: float, decimals: int) -> bool:
    """Whether a number is a fraction of pi, rounded or cut at its last digit; a quarter turn is known by two."""
    digit = 10.0**-decimals
    parts = {2: _QUARTERS}.get(decimals, _PARTS if decimals > 2 else ())
    return any(-digit / 2 <= part - number < digit for part in parts)


_SIDEWAYS_RAD = math.radians(8.0)
"""What brackets and calibrations turn a camera out of the plane of its tool, at most."""
_STRAIGHT_RAD = math.radians(2.0)
_BESIDE_M = 0.02
"""Nearer to the axis of the tool no direction is away from it."""


@rule(Severity.WARNING, assumes=("turned-optical-frame",))
def reversed_angles(graph: CellGraph) -> Findings:
    """Yield cameras on a tool flange that look sideways, and would not with their angles in the reverse order."""
    tools = {device.body.tool_frame for device in graph.cell.devices}
    for device in graph.cell.devices:
        for name in device.body.optical_frames:
            chain = graph.frames.chain(device.body.frames[name])
            place = next((frame for frame in chain if frame.name == device.body.root_link), None)
            if place is None or place.parent not in tools or place.transform_to_parent is None:
                continue
            mount = place.transform_to_parent
            inside = graph.frames.pose_in(device.body.frames[name], device.body.root_link) or identity()
            roll, pitch, yaw = mount.rpy()
            turned = from_xyz_rpy(mount.position, (yaw, pitch, roll))
            sideways = _sideways(mount, inside)
            if sideways > _SIDEWAYS_RAD and _sideways(turned, inside) < _STRAIGHT_RAD:
                degrees = math.degrees(sideways)
                message = f"`{device.name}` looks {degrees:.0f} deg sideways past its tool; with `rpy` in the reverse"
                yield found(graph, (*device.path, "mount", "rpy"), f"{message} order it would look along it")
                break


def _sideways(mount: Pose, inside: Pose) -> float:
    """Return by how much a camera looks out of the plane through itself and the axis of its tool, z, in radians."""
    x, y, _ = mount.position
    beside = math.hypot(x, y)
    if beside < _BESIDE_M:
        return 0.0
    forward = Pose((0.0, 0.0, 0.0), (mount @ inside).quaternion).apply((0.0, 0.0, 1.0))
    return abs(math.asin(max(-1.0, min(1.0, (forward[1] * x - forward[0] * y) / beside))))
