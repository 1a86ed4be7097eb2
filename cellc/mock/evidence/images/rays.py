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
_NEAREST_M = 1e-3
"""In front of the camera: what comes nearer has no outline in the image."""
_EDGE = 1e-6
"""Pixels by which rays at the edge may seem to be outside."""


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
        origin, directions = _from_inside(body, rays[:, window])
        with np.errstate(divide="ignore", invalid="ignore"):
            at = _met(body.shape, origin, directions)
            nearer = (at > 0.0) & (at < depth[window])
            hit = window[nearer]
            depth[hit] = at[nearer]
            facing = _facing(body.shape, origin, directions[:, nearer])
        color[hit] = np.array(body.color) * (_AMBIENT + (1.0 - _AMBIENT) * facing)[:, None]
    return View(depth.reshape(camera.height, camera.width), color.reshape(camera.height, camera.width, 3))


def _window(camera: Pinhole, body: Body) -> NDArray[np.int64] | None:
    """Return the pixels that a body can be in, by the box around it; None where no ray meets that."""
    corners = _corners(body)
    depth, spans = corners[2], list[range]()
    if depth.max() <= 0.0:
        return None
    for across, middle, most in (
        (corners[0], camera.center[0], camera.width),
        (corners[1], camera.center[1], camera.height),
    ):
        outermost = (middle + _EDGE) / camera.focal * depth
        if (across > outermost).all() or (across < -outermost).all():
            return None
        if depth.min() <= _NEAREST_M:
            spans.append(range(most))
            continue
        ends = middle + camera.focal * across / depth
        spans.append(range(max(0, math.floor(ends.min())), min(most, math.ceil(ends.max()) + 1)))
    columns, rows = (np.arange(span.start, max(span.start, span.stop)) for span in spans)
    return (rows[:, None] * camera.width + columns).reshape(-1)


def _corners(body: Body) -> Floats:
    """Return the corners of the box around a body, shape (3, 8)."""
    shape = body.shape
    if isinstance(shape, Box):
        half = tuple(edge / 2.0 for edge in shape.size)
    else:
        half = (shape.radius, shape.radius, shape.radius if isinstance(shape, Sphere) else shape.length / 2.0)
    signs = np.array(list(product((-1.0, 1.0), repeat=3))).T
    corners: Floats = np.array(body.pose.position)[:, None] + _turn(body.pose) @ (np.array(half)[:, None] * signs)
    return corners


def _from_inside(body: Body, rays: Floats) -> tuple[Floats, Floats]:
    """Return where the camera is as a body has it, shape (3, 1), and where its rays go."""
    inside = body.pose.inverse()
    return np.array(inside.position)[:, None], _turn(inside) @ rays


def _turn(pose: Pose) -> Floats:
    turn: Floats = np.array([_turned(pose, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]).T
    return turn


def _turned(pose: Pose, way: tuple[float, float, float]) -> Sequence[float]:
    return [end - start for end, start in zip(pose.apply(way), pose.position, strict=True)]


def _met(shape: Solid, origin: Floats, directions: Floats) -> Floats:
    """Return how far along each ray a shape is met; infinite, or no number, where it is not."""
    if isinstance(shape, Box):
        enters, leaves = _slabs(shape, origin, directions)
        near = enters.max(axis=0)
        return np.where(near <= leaves.min(axis=0), near, math.inf)
    if isinstance(shape, Sphere):
        return _round(directions, origin, shape.radius)
    side, cap, is_cap = _cylinder(shape, origin, directions)
    return np.where(is_cap, cap, side)


def _facing(shape: Solid, origin: Floats, directions: Floats) -> Floats:
    """Return how squarely each ray that meets a shape meets it, in 0..1."""
    normals = np.zeros_like(directions)
    if isinstance(shape, Box):
        enters, _ = _slabs(shape, origin, directions)
        normals[enters.argmax(axis=0), np.arange(directions.shape[1])] = 1.0
    elif isinstance(shape, Sphere):
        normals = (origin + _round(directions, origin, shape.radius) * directions) / shape.radius
    else:
        side, _, is_cap = _cylinder(shape, origin, directions)
        normals[:2] = (origin[:2] + side * directions[:2]) / shape.radius
        normals[:, is_cap] = np.array([[0.0], [0.0], [1.0]])
    squarely: Floats = np.abs(np.sum(normals * directions, axis=0)) / np.sqrt(np.sum(directions**2, axis=0))
    return np.nan_to_num(squarely)


def _slabs(shape: Box, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
    """Return where rays enter and leave the slab of each axis of a box."""
    half = np.array(shape.size)[:, None] / 2.0
    safe = np.where(np.abs(directions) < _PARALLEL, _PARALLEL, directions)
    one, other = (-half - origin) / safe, (half - origin) / safe
    return np.minimum(one, other), np.maximum(one, other)


def _cylinder(shape: Cylinder, origin: Floats, directions: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return where rays meet the side of a cylinder and the plane of its nearer cap, and whether the cap is met."""
    half = shape.length / 2.0
    side = _round(directions[:2], origin[:2], shape.radius)
    side = np.where(np.abs(origin[2] + side * directions[2]) <= half, side, math.inf)
    height = float(origin[2, 0])
    cap = (math.copysign(half, height) - height) / directions[2]
    met = origin[:2] + cap * directions[:2]
    return side, cap, (np.sum(met**2, axis=0) <= shape.radius**2) & (abs(height) > half)


def _round(directions: Floats, origin: Floats, radius: float) -> Floats:
    """Return where rays enter a circle or a sphere about zero; directions are of shape (2 or 3, rays)."""
    square, along = np.sum(directions**2, axis=0), np.sum(directions * origin, axis=0)
    root = along**2 - square * (np.sum(origin**2, axis=0) - radius**2)
    return np.where(root >= 0.0, (-along - np.sqrt(np.maximum(root, 0.0))) / square, math.inf)
