"""A drawing of bodies and frames from two sides.

From the front the eye looks along y, from the side against x, where the drawing is much wider that way; from above it
looks down. Units are millimeters, and each part and each frame is a group that is moved as a whole: what moves by a
millimeter changes a line of each view. Frames have the colors of RViz: x red, y green, z blue.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from xml.etree.ElementTree import Element

from cellc.compiler.formats.escape import one_line
from cellc.compiler.formats.labels import Label, Placed, placed
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.svg import sheet, text
from cellc.compiler.formats.xml_text import element, render
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.robot.description.model import Box, Cylinder, Geometry, Sphere

Point = tuple[float, float]

_AXES = (((1.0, 0.0, 0.0), "#d62728"), ((0.0, 1.0, 0.0), "#2ca02c"), ((0.0, 0.0, 1.0), "#1f77b4"))
_FILLS = ("#d3dce6", "#e6d8d3", "#d6e3d6", "#e3dcc8")
"""Of devices in turn; solid things are gray."""
_SOLID, _EDGE, _BONE = "#e9e9e7", "#76828f", "#30363d"
_ROUND = 16
"""Corners of what is round."""
_MOST_NAMES = 20
"""Frames whose names a view has room for; beyond, those of devices alone are written."""
_SHAPE = 1.5
"""Width over height of the sheet that two views are laid out for."""


@dataclass(frozen=True, slots=True)
class Part:
    """A device or a solid thing with what it carries, all in one frame, meters.

    Args:
        bodies: shapes with their poses; a mesh is left out.
        bones: lines through the links.
        frames: named frames; those that stand in one place share a line.
        solid: it is no device.
    """

    name: str
    origin: Vector3
    bodies: tuple[tuple[Pose, Geometry], ...] = ()
    bones: tuple[tuple[Vector3, Vector3], ...] = ()
    frames: tuple[tuple[str, Pose], ...] = ()
    parts: tuple[Part, ...] = ()
    solid: bool = False

    def all(self) -> Iterator[Part]:
        """Yield the part and those that it carries."""
        yield self
        for part in self.parts:
            yield from part.all()


def two_views(drawing: Part, header: str = "") -> str:
    """Return the picture: from the front or the side, and from above."""
    points = [point for part in drawing.all() for point in _points(part)]
    spans = [max(values) - min(values) for values in zip(*points, strict=True)]
    along = 1 if spans[1] > 2.0 * spans[0] else 0
    largest = max(*spans, 0.05) * 1000.0
    scale = _round_step(largest / 44.0), _round_step(largest / 8.0)
    fills = {part.name: _FILLS[number % len(_FILLS)] for number, part in enumerate(_devices(drawing))}
    first = _View("from the side" if along else "from the front", along, 2, points, scale, fills)
    above = _View("from above", along, 1 - along, points, scale, fills)
    return render(_sheet(drawing, (first, above)), header)


def _round_step(least: float) -> float:
    """Return the least of 1, 2 and 5 times a power of ten that is not below a value."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= least * (1.0 - 1e-9))


def _devices(drawing: Part) -> list[Part]:
    return [part for part in drawing.all() if not part.solid]


class _View:
    """A projection to the plane of two axes, in mm with the second one up.

    What has no size of its own is drawn in units of the ``scale``, whose second part is the ruler.
    """

    def __init__(
        self,
        title: str,
        right: int,
        up: int,
        points: Sequence[Vector3],
        scale: tuple[float, float],
        fills: dict[str, str],
    ) -> None:
        # Seen from above with y to the right, x points down: the eye turns, and nothing is mirrored.
        self._right, self._up, self._sign = right, up, 1.0 if (right, up) == (1, 0) else -1.0
        self.title, self.fills = title, fills
        self.unit, self.ruler = scale
        self.depth = 3 - right - up
        across, down = zip(*map(self.flat, points), strict=True)
        grid = 2.0 * self.unit
        self.left, self.top = (math.floor(min(values) / grid - 1.0) * grid for values in (across, down))
        self.width = math.ceil(max(across) / grid + 1.0) * grid - self.left
        self.height = math.ceil(max(down) / grid + 1.0) * grid - self.top
        self.digits = 0 if self.unit > 10.0 else 1

    def flat(self, point: Vector3) -> Point:
        """Return where a point is seen, unrounded."""
        return point[self._right] * 1000.0, self._sign * point[self._up] * 1000.0

    def seen(self, point: Vector3, origin: Vector3) -> Point:
        """Return where a point is seen from where a group is; the noise of sums does not decide a rounding."""
        (x, y), (x0, y0) = self.flat(point), self.flat(origin)
        return round(round(x - x0, 4), self.digits) + 0.0, round(round(y - y0, 4), self.digits) + 0.0


def _sheet(drawing: Part, views: Sequence[_View]) -> Element:
    """Return both views beside each other, or one below the other where that fits a sheet better."""
    gap = 2.0 * views[0].unit
    size = max(views[0].width + views[1].width + gap, 1.0), max(view.height for view in views)
    beside = size[0] / size[1] <= 2.0 * _SHAPE and size[0] <= 2.2 * size[1]
    if not beside:
        size = max(view.width for view in views), sum(view.height for view in views) + gap
    letter = _letter(size[0])
    title = 2.5 * letter
    width, height = size[0], size[1] + title * (1 if beside else 2)
    parts = list[Element]()
    x = y = 0.0
    for view in views:
        parts += _titled(view, x, y + 1.4 * letter, letter)
        shift = f"translate({x - view.left:g} {y + title - view.top:g})"
        parts.append(element("g", {"transform": shift}, [_bodies(view, drawing), _marks(view, drawing, letter)]))
        x, y = (x + view.width + gap, y) if beside else (x, y + title + view.height + gap)
    return sheet(f"{drawing.name} from two sides, with its frames", width, height, letter, parts)


def _letter(width: float) -> float:
    """Return the size of letters in whole steps of the width, so that a small change leaves it alone."""
    least = width / 75.0
    power = 10.0 ** math.floor(math.log10(least))
    return next(f * power for f in (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0) if f * power >= least)


def _titled(view: _View, x: float, y: float, letter: float) -> Iterator[Element]:
    """Yield the title of a view, and a length that is easy to compare with."""
    inset = x + letter / 2
    yield text(inset, y, view.title, {"font-weight": "bold"})
    start, line = inset + 9.0 * letter, y - letter / 3
    yield _line((start, line), (start + view.ruler, line), "#000000", letter / 8)
    meters = view.ruler / 1000.0
    said = f"{shortest(meters)} m" if meters >= 0.1 else f"{shortest(round(view.ruler, 3))} mm"
    yield text(start + view.ruler + letter / 2, y, said)


def _moved(view: _View, place: Vector3, origin: Vector3, children: Iterable[Element]) -> Element:
    """Return a group that is at a place, to a tenth of the unit: a millimeter more moves it seldom."""
    grid = view.unit / 10.0
    x, y = (round(value / grid) * grid for value in view.seen(place, origin))
    return element("g", {"transform": f"translate({x:g} {y:g})"} if (x, y) != (0.0, 0.0) else {}, children)


def _bodies(view: _View, part: Part, origin: Vector3 = (0.0, 0.0, 0.0)) -> Element:
    """Draw the bodies of a part, the nearest last, and then what it carries."""
    fill = _SOLID if part.solid else view.fills[part.name]
    towards = -1.0 if view.depth == 1 else 1.0
    ordered = sorted(part.bodies, key=lambda body: round(towards * body[0].position[view.depth], 4))
    drawn = [element for pose, shape in ordered for element in _outline(view, pose, shape, part.origin, fill)]
    drawn += [
        _line(view.seen(start, part.origin), view.seen(end, part.origin), _BONE, view.unit / 20.0)
        for start, end in part.bones
    ]
    inner = sorted(part.parts, key=lambda one: (not one.solid, round(towards * one.origin[view.depth], 4)))
    return _moved(view, part.origin, origin, [*drawn, *(_bodies(view, item, part.origin) for item in inner)])


def _outline(view: _View, pose: Pose, shape: Geometry, origin: Vector3, fill: str) -> Iterator[Element]:
    corners = _hull(view.seen(point, origin) for point in _corners(pose, shape))
    if len(corners) > 2:
        points = " ".join(f"{x:g},{y:g}" for x, y in corners)
        style = {"fill": fill, "stroke": _EDGE, "stroke-width": f"{view.unit / 40.0:g}"}
        yield element("polygon", {"points": points} | style)


def _marks(view: _View, drawing: Part, letter: float) -> Element:
    """Draw frames over all bodies, each with its name where there is room."""
    named = sum(len(part.frames) for part in drawing.all()) <= _MOST_NAMES
    labels = [label for part in drawing.all() for label in _labels(view, part, named)]
    bounds = (view.left, view.top, view.left + view.width, view.top + view.height)
    axes = [line for part in drawing.all() for line in _axes(view, part)]
    places = {(item.label.key, item.label.at): item for item in placed(labels, letter, bounds, axes)}
    return _marks_of(view, drawing, (0.0, 0.0, 0.0), letter, places)


def _labels(view: _View, part: Part, named: bool) -> Iterator[Label]:
    """Yield the names of frames, those that stand in one place together; else the name of each device at its mount."""
    for pose, names in _together(view, part)[: None if named else 1]:
        if named or not part.solid:
            yield Label(part.name, _coarse(view, pose.position), ", ".join(names) if named else part.name)


def _axes(view: _View, part: Part) -> Iterator[tuple[Point, Point]]:
    """Yield about where the axes of frames are drawn: a name before one would read as if it had a dash."""
    for pose, _ in _together(view, part):
        at = _coarse(view, pose.position)
        for tip in _tips(view, pose):
            yield at, (at[0] + tip[0], at[1] + tip[1])


def _together(view: _View, part: Part) -> list[tuple[Pose, list[str]]]:
    """Return the frames that stand in one place, with the pose of the first of them."""
    groups: dict[Point, tuple[Pose, list[str]]] = {}
    for name, pose in part.frames:
        groups.setdefault(view.seen(pose.position, part.origin), (pose, []))[1].append(one_line(name))
    return list(groups.values())


def _coarse(view: _View, point: Vector3) -> Point:
    """Return about where a point is seen: a small change of a place leaves names where they are."""
    x, y = view.flat(point)
    grid = view.unit / 2.5
    return round(round(x, 4) / grid) * grid, round(round(y, 4) / grid) * grid


def _marks_of(
    view: _View, part: Part, origin: Vector3, letter: float, places: dict[tuple[str, Point], Placed]
) -> Element:
    drawn = []
    for pose, _ in _together(view, part):
        label = places.get((part.name, _coarse(view, pose.position)))
        drawn.append(_moved(view, pose.position, part.origin, [*_triad(view, pose), *_named(label, letter)]))
    inner = (_marks_of(view, item, part.origin, letter, places) for item in part.parts)
    return _moved(view, part.origin, origin, [*drawn, *inner])


def _named(label: Placed | None, letter: float) -> Iterator[Element]:
    if label is None:
        return
    x, y = label.offset
    if label.far:
        yield _line((0.0, 0.0), label.foot, "#9aa3ad", letter / 14)
    halo = {"stroke": "#ffffff", "stroke-width": f"{letter / 5:g}", "stroke-opacity": "0.8", "paint-order": "stroke"}
    yield text(x, y, label.label.text, {"text-anchor": label.anchor} | halo)


def _triad(view: _View, pose: Pose) -> Iterator[Element]:
    for tip, (_, color) in zip(_tips(view, pose), _AXES, strict=True):
        yield _line((0.0, 0.0), tip, color, view.unit / 12.5)


def _tips(view: _View, pose: Pose) -> Iterator[Point]:
    """Yield where the axes of a frame end as seen from it."""
    reach = view.unit * 1.1e-3
    for axis, _ in _AXES:
        yield view.seen(pose.apply((axis[0] * reach, axis[1] * reach, axis[2] * reach)), pose.position)


def _line(start: Point, end: Point, color: str, width: float) -> Element:
    ends = {"x1": f"{start[0]:g}", "y1": f"{start[1]:g}", "x2": f"{end[0]:g}", "y2": f"{end[1]:g}"}
    return element("line", ends | {"stroke": color, "stroke-width": f"{width:.3g}", "stroke-linecap": "round"})


def _points(part: Part) -> Iterator[Vector3]:
    yield part.origin
    yield from (point for pose, shape in part.bodies for point in _corners(pose, shape))
    yield from (end for bone in part.bones for end in bone)
    yield from (pose.position for _, pose in part.frames)


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
