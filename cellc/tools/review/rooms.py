"""The room of an obstacle or a shared area in its parent: pose and size count together."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import SharedArea
from cellc.contract.transforms import Pose, Vector3, apart
from cellc.robot.description.model import Box, Collision
from cellc.tools.review.covering import covers, is_obstacle
from cellc.tools.review.facts import Facts
from cellc.tools.review.geometry import on_carrier
from cellc.tools.review.leaves import Path
from cellc.tools.review.units import length

_NOTICED, _TOUCHING = 1e-6, 1e-3
"""m and rad; m."""


def obstacle_covers(link: str, before: Facts, after: Facts) -> bool | None:
    """Tell whether an obstacle takes up all the room that it took, whatever its parent is; None of anything else.

    Both sides are in the nearest link that moves, or in the root; of obstacles on two of these nothing is known.
    """
    was, now = _room(link, before), _room(link, after)
    if was is None or now is None or was[0] != now[0]:
        return None
    return covers(was[1], now[1])


def keeps_apart(name: str, before: Facts, after: Facts) -> bool:
    """Tell whether arms are kept apart in all the room of a shared area in which they were.

    One arm at a time is in it, unless it is released: of a released one, arms may meet in no more room than before.
    """
    was, now = (_shared(name, facts.cell) for facts in (before, after))
    if was is None or now is None or was.parent != now.parent:
        return False
    old, new = ((Collision(None, area.transform_to_parent, Box(area.size)),) for area in (was, now))
    if now.released:
        return now.released == was.released and covers(new, old)
    return bool(was.released) or covers(old, new)


def box_difference(path: Path, before: Facts, after: Facts) -> str:
    """Return what the box of an obstacle or a shared area gains and loses on each side; empty of another shape."""
    if path[:1] == ("area",):
        was, now = _area(path[1], before.cell), _area(path[1], after.cell)
    else:
        was, now = _box(path[2], before), _box(path[2], after)
    if was is None or now is None or was[0] != now[0]:
        return ""
    (_, pose, size), (_, new_pose, new_size) = was, now
    if apart(pose, new_pose)[1] > _NOTICED:
        return ""
    sides = _sides(pose, size, new_pose, new_size)
    return ", ".join(sorted(sides, key=lambda text: not text.startswith("loses")))


def room_difference(link: str, before: Facts, after: Facts) -> str:
    """Return what the room of an obstacle that moved gains and loses, and how far it is from what it touched.

    Empty of what is no obstacle, or of one that is not a box.
    """
    was, now = _box(link, before), _box(link, after)
    if was is None or now is None or was[0] != now[0]:
        return ""
    (_, pose, size), (_, new_pose, new_size) = was, now
    gap = _gap(pose, size, new_pose, new_size)
    if gap is None:
        return ""
    if gap > _NOTICED:
        told = f"{length(gap)} clear of where it was"
    else:
        told = box_difference(("real", "shapes", link), before, after)
    left = [
        f"{length(far)} clear of `{other}`, which it touched"
        for other, (near, far) in _gaps_of(link, was, now, before, after)
        if abs(near) <= _TOUCHING and far > _TOUCHING
    ]
    return "; ".join(part for part in (told, *left) if part)


def is_part_of_scene(link: str, facts: Facts) -> bool:
    """Tell whether a link collides and belongs to no device."""
    return is_obstacle(facts.description, link, [device.root_link for device in facts.contract.devices.values()])


def _gaps_of(
    link: str, was: _Placed, now: _Placed, before: Facts, after: Facts
) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield how far an obstacle was and is from each other box on the same carrier, below 0 where they overlap."""
    for other in (each.name for each in before.description.links if each.name != link):
        near, far = _box(other, before), _box(other, after)
        if near is not None and far is not None and near[0] == was[0] == far[0]:
            gaps = (_gap(*near[1:], *was[1:]), _gap(*far[1:], *now[1:]))
            if gaps[0] is not None and gaps[1] is not None:
                yield other, (gaps[0], gaps[1])


def _gap(pose: Pose, size: Vector3, other: Pose, other_size: Vector3) -> float | None:
    """Return how far two boxes are from each other along the axes of both; None of boxes that are turned apart."""
    if apart(pose, other)[1] > _NOTICED:
        return None
    place = (pose.inverse() @ other).position
    gaps = [abs(at) - (one + two) / 2 for at, one, two in zip(place, size, other_size, strict=True)]
    return math.hypot(*(gap for gap in gaps if gap > 0.0)) if max(gaps) > 0.0 else max(gaps)


_Placed = tuple[str, Pose, Vector3]
"""Parent, center and full edge lengths."""


def _room(link: str, facts: Facts) -> tuple[str, Sequence[Collision]] | None:
    if not is_part_of_scene(link, facts):
        return None
    carried = on_carrier(link, facts)
    shapes = next((each.collisions for each in facts.description.links if each.name == link), ())
    if carried is None:
        return None
    carrier, pose = carried
    return carrier, tuple(replace(shape, pose=pose @ shape.pose) for shape in shapes)


def _box(link: str, facts: Facts) -> _Placed | None:
    room = _room(link, facts)
    if room is None or len(room[1]) != 1:
        return None
    (shape,) = room[1]
    return (room[0], shape.pose, shape.geometry.size) if isinstance(shape.geometry, Box) else None


def _area(name: str, cell: Cell | None) -> _Placed | None:
    area = _shared(name, cell)
    return None if area is None else (area.parent, area.transform_to_parent, area.size)


def _shared(name: str, cell: Cell | None) -> SharedArea | None:
    return next((each for each in (() if cell is None else cell.areas) if each.name == name), None)


def _sides(pose: Pose, size: Vector3, new_pose: Pose, new_size: Vector3) -> tuple[str, ...]:
    """Return what each side gains or loses, along the axes of the box."""
    turned = Pose((0.0, 0.0, 0.0), pose.quaternion)
    was, now = (turned.inverse().apply(each.position) for each in (pose, new_pose))
    is_upright = turned.apply((0.0, 0.0, 1.0))[2] >= 1.0 - _NOTICED
    sides = list[str]()
    for number, axis in enumerate("xyz"):
        grown, moved = (new_size[number] - size[number]) / 2, now[number] - was[number]
        ends = ("the bottom", "the top") if axis == "z" and is_upright else (f"-{axis}", f"+{axis}")
        sides += _ends(axis, grown - moved, grown + moved, ends)
    return tuple(sides)


def _ends(axis: str, low: float, high: float, names: tuple[str, str]) -> Iterator[str]:
    if abs(low - high) <= _NOTICED and abs(low) > _NOTICED:
        yield f"{_verb(low)} {length(abs(low))} on each side in {axis}"
        return
    for grown, name in ((low, names[0]), (high, names[1])):
        if abs(grown) > _NOTICED:
            yield f"{_verb(grown)} {length(abs(grown))} at {name}"


def _verb(grown: float) -> str:
    return "gains" if grown > 0.0 else "loses"
