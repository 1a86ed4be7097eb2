"""Boxes, cylinders and spheres as a pinhole camera sees them: depth along the optical axis and flat shading.

One ray goes through the center of each pixel, and meets each shape in closed form (slabs of a box: Kay and Kajiya, Ray
tracing complex scenes, 1986). The camera looks along z, with x to the right and y down, as REP 103 has optical frames.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import product
from typing import TypeAlias, Union

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.robot.description.model import Box, Cylinder, Sphere

Floats: TypeAlias = NDArray[np.float64]
Solid: TypeAlias = Union[Box, Cylinder, Sphere]
Color: TypeAlias = tuple[float, float, float]
"""Red, green and blue in 0..1."""

BACKGROUND: Color = (0.86, 0.88, 0.90)
_AMBIENT = 0.35
"""Of the brightness that a face has that is looked at squarely."""
_PARALLEL = 1e-12


@dataclass(frozen=True, slots=True)
class Pinhole:
    """A camera without distortion: square pixels, of which the first has its center at 0, 0.

    Attributes:
        focal: focal length in pixels.
    """

    width: int
    height: int
    focal: float

    @property
    def center(self) -> tuple[float, float]:
        """The pixel on the optical axis: the middle of the image."""
        return (self.width - 1) / 2.0, (self.height - 1) / 2.0

    def rays(self) -> Floats:
        """Return the direction of each pixel's ray, one long along the optical axis, shape (3, height * width)."""
        (u, v), (cu, cv) = np.meshgrid(np.arange(self.width), np.arange(self.height)), self.center
        return np.stack([(u - cu) / self.focal, (v - cv) / self.focal, np.ones(u.shape)]).reshape(3, -1)


def pinhole(width: int, height: int, horizontal: float, vertical: float, most: int) -> Pinhole:
    """Return a camera that sees no more than two angles, scaled down by a whole factor to a width.

    A sensor has square pixels. Where the angles are those of another format, the narrower one counts.

    Args:
        horizontal, vertical: whole angles of view in rad.
        most: pixels of the width.
    """
    focal = max(width / 2.0 / math.tan(horizontal / 2.0), height / 2.0 / math.tan(vertical / 2.0))
    factor = -(-width // most)
    return Pinhole(max(1, width // factor), max(1, height // factor), focal / factor)


@dataclass(frozen=True, slots=True)
class Body:
    """A shape, where it is in the optical frame, and its color."""

    shape: Solid
    pose: Pose
    color: Color


@dataclass(frozen=True, slots=True)
class View:
    """What is seen: depth in m along the optical axis, infinite where nothing is, and colors in 0..1."""

    depth: Floats
    color: Floats


def seen(camera: Pinhole, bodies: Iterable[Body]) -> View:
    """Return what a camera sees; a body around the camera, such as its own housing, is looked through."""
    rays = camera.rays()
    depth, color = np.full(rays.shape[1], math.inf), np.tile(np.array(BACKGROUND), (rays.shape[1], 1))
    for body in bodies:
        window = _window(camera, body)
        if window is None:
            continue
        at, facing = _met(body, rays[:, window])
        nearer = at < depth[window]
        hit = window[nearer]
        depth[hit] = at[nearer]
        color[hit] = np.array(body.color) * (_AMBIENT + (1.0 - _AMBIENT) * facing[nearer])[:, None]
    return View(depth.reshape(camera.height, camera.width), color.reshape(camera.height, camera.width, 3))


def _window(camera: Pinhole, body: Body) -> NDArray[np.int64] | None:
    """Return the pixels that a body can be in, by the ball around it; None where it is behind the camera."""
    radius = _radius(body.shape)
    x, y, z = body.pose.position
    if z + radius <= 0.0:
        return None
    if z - radius <= 1e-3:
        return np.arange(camera.width * camera.height)
    spans: list[range] = []
    for place, middle, most in ((x, camera.center[0], camera.width), (y, camera.center[1], camera.height)):
        corners = product((-radius, radius), repeat=2)
        ends = [middle + camera.focal * (place + side) / (z + way) for side, way in corners]
        spans.append(range(max(0, math.floor(min(ends))), min(most, math.ceil(max(ends)) + 1)))
    columns, rows = (np.arange(span.start, max(span.start, span.stop)) for span in spans)
    return (rows[:, None] * camera.width + columns).reshape(-1)


def _radius(shape: Solid) -> float:
    if isinstance(shape, Sphere):
        return shape.radius
    return math.hypot(*shape.size) / 2.0 if isinstance(shape, Box) else math.hypot(shape.radius, shape.length / 2.0)


def _met(body: Body, rays: Floats) -> tuple[Floats, Floats]:
    """Return how far along each ray a body is met, infinite where it is not, and how squarely in 0..1."""
    inside = body.pose.inverse()
    turn = np.array([_turned(inside, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))])
    origin, directions = np.array(inside.position)[:, None], turn.T @ rays
    with np.errstate(divide="ignore", invalid="ignore"):
        if isinstance(body.shape, Box):
            at, normals = _box(np.array(body.shape.size)[:, None] / 2.0, origin, directions)
        elif isinstance(body.shape, Sphere):
            at, normals = _sphere(body.shape.radius, origin, directions)
        else:
            at, normals = _cylinder(body.shape.radius, body.shape.length / 2.0, origin, directions)
        squarely = np.abs(np.sum(normals * directions, axis=0)) / np.sqrt(np.sum(directions**2, axis=0))
    return np.where(np.isfinite(at) & (at > 0.0), at, math.inf), np.nan_to_num(squarely)


def _turned(pose: Pose, way: tuple[float, float, float]) -> Sequence[float]:
    return [end - start for end, start in zip(pose.apply(way), pose.position, strict=True)]


def _box(half: Floats, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
    safe = np.where(np.abs(directions) < _PARALLEL, _PARALLEL, directions)
    one, other = (-half - origin) / safe, (half - origin) / safe
    enters, leaves = np.minimum(one, other), np.maximum(one, other)
    near, far = enters.max(axis=0), leaves.min(axis=0)
    normals = np.zeros_like(directions)
    normals[enters.argmax(axis=0), np.arange(directions.shape[1])] = 1.0
    return np.where(near <= far, near, math.inf), normals


def _sphere(radius: float, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
    at = _round(directions, origin, radius)
    return at, (origin + at * directions) / radius


def _cylinder(radius: float, half: float, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
    side = _round(directions[:2], origin[:2], radius)
    points = origin + side * directions
    side = np.where(np.abs(points[2]) <= half, side, math.inf)
    normals = np.concatenate([points[:2] / radius, np.zeros((1, directions.shape[1]))])
    height = float(origin[2, 0])
    cap = (math.copysign(half, height) - height) / directions[2]
    met = origin[:2] + cap * directions[:2]
    is_cap = (np.sum(met**2, axis=0) <= radius**2) & (abs(height) > half)
    normals[:, is_cap] = np.array([[0.0], [0.0], [1.0]])
    return np.where(is_cap, cap, side), normals


def _round(directions: Floats, origin: Floats, radius: float) -> Floats:
    """Return where rays enter a circle or a sphere about zero; directions are of shape (2 or 3, rays)."""
    square, along = np.sum(directions**2, axis=0), np.sum(directions * origin, axis=0)
    root = along**2 - square * (np.sum(origin**2, axis=0) - radius**2)
    return np.where(root >= 0.0, (-along - np.sqrt(np.maximum(root, 0.0))) / square, math.inf)
