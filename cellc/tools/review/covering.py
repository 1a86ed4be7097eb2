"""Whether the collision shapes of a link still take up all the room that they took: planning avoids no other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

from cellc.contract.transforms import Vector3, apart
from cellc.robot.description.model import Box, Collision, Cylinder, Description, Geometry, Sphere

_SLACK = 1e-6
"""m and rad."""


def covers(before: Sequence[Collision], after: Sequence[Collision]) -> bool:
    """Tell whether each shape lies in one of those after the change, as far as shapes alone can tell."""
    return all(any(_lies_in(shape, other) for other in after) for shape in before)


def is_obstacle(body: Description, link: str, devices: Sequence[str]) -> bool:
    """Tell whether a link collides and hangs on no device: it is a part of the scene.

    Args:
        devices: root links of the devices.
    """
    if not any(each.name == link and each.collisions for each in body.links):
        return False
    parents = {joint.child: joint.parent for joint in body.joints}
    seen = set[str]()
    while link in parents and link not in seen:
        if link in devices:
            return False
        seen.add(link)
        link = parents[link]
    return link not in devices


def _lies_in(shape: Collision, other: Collision) -> bool:
    if shape.geometry == other.geometry and max(apart(shape.pose, other.pose)) <= _SLACK:
        return True
    place = other.pose.inverse() @ shape.pose
    if isinstance(shape.geometry, Sphere) and isinstance(other.geometry, Sphere):
        return math.hypot(*place.position) + shape.geometry.radius <= other.geometry.radius + _SLACK
    if isinstance(shape.geometry, Cylinder) and isinstance(other.geometry, Cylinder):
        is_upright = abs(place.apply((0.0, 0.0, 1.0))[2] - place.position[2]) >= 1.0 - _SLACK
        if is_upright:
            aside = math.hypot(*place.position[:2]) + shape.geometry.radius <= other.geometry.radius + _SLACK
            ends = abs(place.position[2]) + shape.geometry.length / 2 <= other.geometry.length / 2 + _SLACK
            return aside and ends
    corners = [*map(place.apply, corners_of(shape.geometry))]
    return bool(corners) and all(_has(other.geometry, corner) for corner in corners)


def corners_of(geometry: Geometry) -> Iterator[Vector3]:
    """Yield the corners of the box about a shape; of a mesh none, for its file is not read here."""
    if isinstance(geometry, Box):
        x, y, z = geometry.size
    elif isinstance(geometry, Cylinder):
        x, y, z = 2 * geometry.radius, 2 * geometry.radius, geometry.length
    elif isinstance(geometry, Sphere):
        x = y = z = 2 * geometry.radius
    else:
        return
    for signs in itertools.product((-0.5, 0.5), repeat=3):
        yield x * signs[0], y * signs[1], z * signs[2]


def _has(geometry: Geometry, point: Vector3) -> bool:
    if isinstance(geometry, Box):
        return all(abs(at) <= size / 2 + _SLACK for at, size in zip(point, geometry.size, strict=True))
    if isinstance(geometry, Sphere):
        return math.hypot(*point) <= geometry.radius + _SLACK
    if isinstance(geometry, Cylinder):
        is_within = math.hypot(*point[:2]) <= geometry.radius + _SLACK
        return is_within and abs(point[2]) <= geometry.length / 2 + _SLACK
    return False
