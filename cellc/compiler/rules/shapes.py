"""Boxes around the shapes of links, for rules on descriptions."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

from cellc.contract.transforms import Vector3
from cellc.robot.description.model import Box, Collision, Cylinder, Geometry, Sphere, Visual


def edges(shape: Geometry) -> Vector3:
    """Return the edges of the box around a shape that is no mesh, m."""
    if isinstance(shape, Cylinder):
        return 2.0 * shape.radius, 2.0 * shape.radius, shape.length
    if isinstance(shape, Sphere):
        return 2.0 * shape.radius, 2.0 * shape.radius, 2.0 * shape.radius
    return shape.size if isinstance(shape, Box) else (0.0, 0.0, 0.0)


def box_corners(shape: Collision | Visual) -> Iterator[Vector3]:
    """Yield the corners of the box around a shape, in its link."""
    half = [edge / 2.0 for edge in edges(shape.geometry)]
    for x, y, z in itertools.product((-1.0, 1.0), repeat=3):
        yield shape.pose.apply((x * half[0], y * half[1], z * half[2]))


def beside(point: Vector3, corners: Sequence[Vector3]) -> float:
    """Return how far a point is outside of the upright box around corners, m; 0 inside."""
    ways = (
        max(
            min(corner[axis] for corner in corners) - point[axis], point[axis] - max(corner[axis] for corner in corners)
        )
        for axis in range(3)
    )
    return math.hypot(*(max(0.0, way) for way in ways))


def dot(one: Vector3, other: Vector3) -> float:
    """Return the scalar product."""
    return sum(a * b for a, b in zip(one, other, strict=True))
