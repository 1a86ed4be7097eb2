"""Names beside points of a drawing: each at the nearest side that is free, with a line to its point where it is far."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil, floor, inf

from cellc.contract.frozen import dataclass

Point = tuple[float, float]
_Box = tuple[float, float, float, float]

_LETTER = 0.56
"""Width of a character over its height, about what sans-serif sets on average."""
_FAR = 2.0
"""Letters from the point beyond which a line leads there."""


@dataclass(frozen=True, slots=True)
class Label:
    """A text for a point; ``key`` tells apart what is in one place."""

    key: str
    at: Point
    text: str


@dataclass(frozen=True, slots=True)
class Placed:
    """Where a text is from its point: its base line begins, is centered or ends there.

    Attributes:
        foot: end of the line that leads to it, where it is far.
    """

    label: Label
    offset: Point
    anchor: str
    foot: Point
    far: bool


class _Taken:
    """Boxes that are taken, by the squares of a grid that they lie in: those far from a text hide nothing of it."""

    def __init__(self, side: float) -> None:
        self._side = side
        self._boxes: list[_Box] = []
        self._squares: dict[tuple[int, int], list[int]] = {}

    def add(self, box: _Box) -> None:
        for square in self._covered(box):
            self._squares.setdefault(square, []).append(len(self._boxes))
        self._boxes.append(box)

    def near(self, box: _Box) -> list[_Box]:
        """Return those that may overlap a box, in the order in which they were added."""
        numbers = {number for square in self._covered(box) for number in self._squares.get(square, ())}
        return [self._boxes[number] for number in sorted(numbers)]

    def _covered(self, box: _Box) -> list[tuple[int, int]]:
        left, top, right, bottom = (floor(value / self._side) for value in box)
        return [(x, y) for x in range(left, right + 1) for y in range(top, bottom + 1)]


def placed(
    labels: Iterable[Label], letter: float, bounds: _Box, lines: Iterable[tuple[Point, Point]] = ()
) -> tuple[Placed, ...]:
    """Return where each text is; one without room within the bounds is where it hides least.

    Args:
        letter: height of letters.
        bounds: left, top, right, bottom.
        lines: what else is drawn.
    """
    ordered = sorted(labels, key=lambda label: (label.at[1], label.at[0], label.key))
    taken = _Taken(letter * 2)
    for item in ordered:
        taken.add(_around(item.at, letter * 0.4))
    for box in (box for line in lines for box in _along(*line, letter)):
        taken.add(box)
    placements = []
    for label in ordered:
        best, box = _best(label, letter, taken, bounds)
        taken.add(box)
        placements.append(best)
    return tuple(placements)


def _best(label: Label, letter: float, taken: _Taken, bounds: _Box) -> tuple[Placed, _Box]:
    """Return the place of the least cost, the first of them; a place is left once it costs more than another."""
    choices = _choices(label, letter)
    best, box, distance = next(choices)
    least = _cost(box, taken.near(box), bounds, inf) + distance
    for position, other, distance in choices:
        cost = _cost(other, taken.near(other), bounds, least - distance) + distance
        if cost < least:
            best, box, least = position, other, cost
    return best, box


def _choices(label: Label, letter: float) -> Iterator[tuple[Placed, _Box, float]]:
    """Yield places around a point, the nearest first, with the box of the text and what its distance costs."""
    wide = len(label.text) * letter * _LETTER
    for away in (0.7, 1.6, 2.8, 4.2, 6.0):
        for side, up in ((1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1), (0, 1), (0, -1)):
            # Beside the point or over it; slanted, half as far to each side.
            x = side * letter * (away if up == 0 else away / 2)
            y = -up * letter * (away + 0.3) + (letter * 0.35 if up >= 0 else letter * 0.7)
            left = label.at[0] + x - wide * {1: 0.0, 0: 0.5, -1: 1.0}[side]
            base = label.at[1] + y
            box = (left, base - letter * 0.85, left + wide, base + letter * 0.25)
            anchor = {1: "start", 0: "middle", -1: "end"}[side]
            foot = (_tidy(x), _tidy(y - letter * 0.3))
            yield Placed(label, (_tidy(x), _tidy(y)), anchor, foot, away >= _FAR), box, away * letter * letter * 0.5


def _tidy(value: float) -> float:
    return round(value, 1) + 0.0


def _around(point: Point, half: float) -> _Box:
    return (point[0] - half, point[1] - half, point[0] + half, point[1] + half)


def _along(start: Point, end: Point, letter: float) -> Iterator[_Box]:
    """Yield boxes on the way of a line, half a letter apart."""
    steps = max(1, ceil(max(abs(end[0] - start[0]), abs(end[1] - start[1])) / (letter / 2)))
    for step in range(1, steps + 1):
        share = step / steps
        at = (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
        yield _around(at, letter / 4)


def _cost(box: _Box, taken: Iterable[_Box], bounds: _Box, most: float) -> float:
    """Return the area that is hidden or lies outside, ten times as dear as distance; above ``most`` any that is."""
    whole, inside, hidden = (box[2] - box[0]) * (box[3] - box[1]), _shared(box, bounds), 0.0
    for other in taken:
        hidden += _shared(box, other)
        if 10.0 * (hidden + whole - inside) > most:
            break
    return 10.0 * (hidden + whole - inside)


def _shared(one: _Box, other: _Box) -> float:
    wide = min(one[2], other[2]) - max(one[0], other[0])
    high = min(one[3], other[3]) - max(one[1], other[1])
    return wide * high if wide > 0.0 and high > 0.0 else 0.0
