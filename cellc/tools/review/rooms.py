"""The room of an obstacle or a shared area in its parent: pose and size count together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import SharedArea
from cellc.contract.transforms import Pose, Vector3, apart
from cellc.robot.description.model import Box, Collision
from cellc.tools.review.covering import covers, is_obstacle
from cellc.tools.review.facts import Facts
from cellc.tools.review.leaves import Path
from cellc.tools.review.units import length

_NOTICED = 1e-6
"""m and rad."""


def obstacle_covers(link: str, before: Facts, after: Facts) -> bool | None:
    """Tell whether an obstacle takes up all the room that it took; None of what is no obstacle in the same parent."""
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


def is_part_of_scene(link: str, facts: Facts) -> bool:
    """Tell whether a link collides and belongs to no device."""
    return is_obstacle(facts.description, link, [device.root_link for device in facts.contract.devices.values()])


_Placed = tuple[str, Pose, Vector3]
"""Parent, center and full edge lengths."""


def _room(link: str, facts: Facts) -> tuple[str, Sequence[Collision]] | None:
    if not is_part_of_scene(link, facts):
        return None
    joint = next((each for each in facts.description.joints if each.child == link), None)
    shapes = next((each.collisions for each in facts.description.links if each.name == link), ())
    if joint is None:
        return None
    return joint.parent, tuple(replace(shape, pose=joint.pose @ shape.pose) for shape in shapes)


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
