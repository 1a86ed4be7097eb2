"""A drawing of bodies and frames from two sides, as SVG 1.1 without scripts, styles or fonts from elsewhere.

From the side the eye looks along y, and x points to the right; from above it looks down, and x points to the right too.
Frames have the colours of RViz: x red, y green, z blue.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.description.model import Box, Cylinder, Geometry, Sphere
from cellc.formats.escape import one_line
from cellc.formats.numbers import shortest
from cellc.formats.xml_text import element, render
from cellc.transforms import Pose, Vector3

Point = tuple[float, float]

_VIEW = 420
"""Width and height of what is drawn of one view."""
_LABELS = 150
"""Width beside a view in which names stand."""
_MARGIN = 24
_LINE = 15
_AXES = (((1.0, 0.0, 0.0), "#d62728"), ((0.0, 1.0, 0.0), "#2ca02c"), ((0.0, 0.0, 1.0), "#1f77b4"))
_ROUND = 16
"""Corners of what is round."""


@dataclass(frozen=True, slots=True)
class Drawing:
    """What is drawn, all in one frame, metres.

    Args:
        bodies: shapes with their poses; a mesh is left out.
        bones: from each frame to the next.
        frames: named frames; those that stand in one place share a line.
    """

    bodies: tuple[tuple[Pose, Geometry], ...]
    bones: tuple[tuple[Vector3, Vector3], ...]
    frames: tuple[tuple[str, Pose], ...]


def two_views(drawing: Drawing) -> str:
    """Return the picture: from the side, and from above."""
    corners = [point for pose, shape in drawing.bodies for point in _corners(pose, shape)]
    points = [
        *corners,
        *(end for bone in drawing.bones for end in bone),
        *(pose.position for _, pose in drawing.frames),
    ]
    views = [_View("from the side", 0, 2, points), _View("from above", 0, 1, points)]
    width = len(views) * (_VIEW + _LABELS + _MARGIN) + _MARGIN
    height = max(view.height for view in views) + 3 * _MARGIN
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg",
        "viewBox": f"0 0 {width} {height:.0f}",
        "font-family": "sans-serif",
        "font-size": "12",
    }
    parts = [element("rect", {"width": "100%", "height": "100%", "fill": "#ffffff"})]
    for number, view in enumerate(views):
        shift = _MARGIN + number * (_VIEW + _LABELS + _MARGIN)
        parts.append(element("g", {"transform": f"translate({shift} {_MARGIN})"}, _drawn(view, drawing)))
    return render(element("svg", attributes, parts))


class _View:
    """A projection to the plane of two coordinates, scaled so that everything fits."""

    def __init__(self, title: str, right: int, up: int, points: Sequence[Vector3]) -> None:
        self.title, self._right, self._up = title, right, up
        across, along = [point[right] for point in points] or [0.0], [point[up] for point in points] or [0.0]
        self._left, self._top = min(across), max(along)
        extent = max(max(across) - self._left, self._top - min(along), 0.05)
        self.scale = _VIEW / extent
        self.height = (self._top - min(along)) * self.scale + 2 * _LINE

    def at(self, point: Vector3) -> Point:
        x, y = (point[self._right] - self._left) * self.scale, (self._top - point[self._up]) * self.scale
        return (round(x, 1) + 0.0, round(y + 2 * _LINE, 1) + 0.0)


def _drawn(view: _View, drawing: Drawing) -> Iterator[Element]:
    yield element("text", {"x": "0", "y": "0", "font-weight": "bold"}, text=view.title)
    yield from _ruler(view)
    for pose, shape in drawing.bodies:
        outline = _hull(view.at(point) for point in _corners(pose, shape))
        if len(outline) > 2:
            points = " ".join(f"{x:g},{y:g}" for x, y in outline)
            yield element("polygon", {"points": points, "fill": "#c9d3de", "fill-opacity": "0.5", "stroke": "#8a97a5"})
    for start, end in drawing.bones:
        yield _line(view.at(start), view.at(end), "#30363d", 3)
    for _, pose in drawing.frames:
        yield from _triad(view, pose)
    yield from _names(view, drawing.frames)


def _ruler(view: _View) -> Iterator[Element]:
    """Draw a length that is easy to compare with, at most half as long as the view."""
    length = max(one for one in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0) if one * view.scale <= _VIEW / 2)
    end = round(length * view.scale, 1)
    yield _line((100.0, -4.0), (100.0 + end, -4.0), "#000000", 2)
    said = f"{shortest(length)} m" if length >= 0.1 else f"{length * 1000:.0f} mm"
    yield element("text", {"x": f"{106 + end:g}", "y": "0"}, text=said)


def _triad(view: _View, pose: Pose) -> Iterator[Element]:
    reach = 24.0 / view.scale
    for axis, colour in _AXES:
        tip = pose.apply((axis[0] * reach, axis[1] * reach, axis[2] * reach))
        yield _line(view.at(pose.position), view.at(tip), colour, 2)


def _names(view: _View, frames: Iterable[tuple[str, Pose]]) -> Iterator[Element]:
    """Write the names beside the view, one below the other, each with a line to where its frame stands."""
    together: dict[Point, list[str]] = {}
    for name, pose in frames:
        together.setdefault(view.at(pose.position), []).append(name)
    lowest = -math.inf
    for place in sorted(together, key=lambda point: (point[1], point[0])):
        lowest = max(place[1], lowest + _LINE)
        yield _line(place, (_VIEW + 8.0, lowest), "#b9c1ca", 1)
        style = {"x": str(_VIEW + 12), "y": f"{lowest + 4:g}"}
        yield element("text", style, text=one_line(", ".join(together[place])))


def _line(start: Point, end: Point, colour: str, width: int) -> Element:
    ends = {"x1": f"{start[0]:g}", "y1": f"{start[1]:g}", "x2": f"{end[0]:g}", "y2": f"{end[1]:g}"}
    return element("line", ends | {"stroke": colour, "stroke-width": str(width), "stroke-linecap": "round"})


def _corners(pose: Pose, shape: Geometry) -> Iterator[Vector3]:
    """Yield points whose hull is the shape, as well as a drawing needs it."""
    if isinstance(shape, Box):
        x, y, z = (half / 2.0 for half in shape.size)
        yield from (pose.apply((a, b, c)) for a in (-x, x) for b in (-y, y) for c in (-z, z))
    elif isinstance(shape, Cylinder):
        for height in (-shape.length / 2.0, shape.length / 2.0):
            yield from (pose.apply((x, y, height)) for x, y in _circle(shape.radius))
    elif isinstance(shape, Sphere):
        for turn in _circle(1.0):
            yield from (pose.apply((x * turn[0], y, x * turn[1])) for x, y in _circle(shape.radius))


def _circle(radius: float) -> Iterator[Point]:
    angles = (2.0 * math.pi * step / _ROUND for step in range(_ROUND))
    return ((radius * math.cos(angle), radius * math.sin(angle)) for angle in angles)


def _hull(points: Iterable[Point]) -> list[Point]:
    """Return the corners of the convex hull in order. Source: A. M. Andrew, Inf. Process. Lett. 9 (1979) 216."""
    ordered = sorted(set(points))
    return [*_chain(ordered)[:-1], *_chain(reversed(ordered))[:-1]]


def _chain(ordered: Iterable[Point]) -> list[Point]:
    chain: list[Point] = []
    for point in ordered:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
