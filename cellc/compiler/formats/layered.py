"""A layered drawing of a graph: boxes in columns, each once, and lines that pass between the boxes of a column.

After K. Sugiyama, S. Tagawa, M. Toda, IEEE Trans. Syst. Man Cybern. 11 (1981) 109, with given layers: a line across a
layer has a place of its own there, the order in each layer follows the mean place of the neighbors, and so do heights.
networkx (3.6, `multipartite_layout`) places boxes alone, in the order given: it neither sorts a layer nor routes lines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise

from cellc.contract.frozen import dataclass

Point = tuple[float, float]

_SWEEPS = 12
_LANE = 12.0
"""Height of a line that crosses a layer."""
_APART = 12.0
"""Between two boxes of a layer; two lines lie closer."""
PORT = 14.0
"""Between two lines that end at one side of a box."""


@dataclass(frozen=True, slots=True)
class Box:
    """A node of the graph; ``height`` is the least that its text needs."""

    key: str
    layer: int
    height: float


@dataclass(frozen=True, slots=True)
class Line:
    """An edge; lines of one group that end at the same box share their end there."""

    start: str
    end: str
    group: str


@dataclass(frozen=True, slots=True)
class Columns:
    """Left edge of each layer, and the width of its boxes."""

    lefts: tuple[float, ...]
    width: float


@dataclass(frozen=True, slots=True)
class Layout:
    """Center and height of each box along y from 0, the points of each line in pairs, and the height of it all."""

    boxes: Mapping[str, tuple[float, float]]
    routes: tuple[tuple[Point, ...], ...]
    height: float


def layout(boxes: Sequence[Box], lines: Sequence[Line], columns: Columns) -> Layout:
    """Place boxes and lines; the same graph gives the same drawing."""
    return _Drawing(boxes, lines, columns).layout()


class _Drawing:
    """Slots of the layers, which are boxes, and places where lines cross a layer."""

    def __init__(self, boxes: Sequence[Box], lines: Sequence[Line], columns: Columns) -> None:
        self._columns = columns
        self._layers = {box.key: box.layer for box in boxes}
        self._lines = lines
        self._chains = [tuple(self._chain(line)) for line in lines]
        self._near: dict[str, set[str]] = {}
        for first, other in (pair for chain in self._chains for pair in pairwise(chain)):
            self._near.setdefault(first, set()).add(other)
            self._near.setdefault(other, set()).add(first)
        self._sides = self._ends()
        self._heights = {box.key: self._height(box) for box in boxes}
        self._order: list[list[str]] = [[] for _ in columns.lefts]
        for key, layer in self._layers.items():
            self._order[layer].append(key)
        self._places = {key: share for keys in self._order for key, share in _shares(keys)}

    def layout(self) -> Layout:
        for _ in range(_SWEEPS):
            for layer in (*range(len(self._order)), *reversed(range(len(self._order)))):
                self._sort(layer)
        centers = self._centers()
        boxes = {key: (centers[key], height) for key, height in self._heights.items()}
        ports = dict(self._ports(centers))
        routes = tuple(
            tuple(self._route(line, chain, centers, ports))
            for line, chain in zip(self._lines, self._chains, strict=True)
        )
        height = max((centers[key] + self._high(key) / 2.0 for key in centers), default=0.0)
        return Layout(boxes, routes, height)

    def _chain(self, line: Line) -> Iterator[str]:
        """Yield the slots of a line from its start to its end; those between are made here."""
        first, last = self._layers[line.start], self._layers[line.end]
        step = 1 if last > first else -1
        yield line.start
        for layer in range(first + step, last, step):
            slot = f"{line.group}\n{line.start}\n{layer}\n{step}"
            self._layers[slot] = layer
            yield slot
        yield line.end

    def _ends(self) -> dict[tuple[str, int], dict[str, set[str]]]:
        """Return what ends at each side of each box, by group: the slots on the other end of the first piece."""
        ends: dict[tuple[str, int], dict[str, set[str]]] = {}
        for line, chain in zip(self._lines, self._chains, strict=True):
            for key, other in ((chain[0], chain[1]), (chain[-1], chain[-2])):
                ends.setdefault((key, self._side(key, other)), {}).setdefault(line.group, set()).add(other)
        return ends

    def _side(self, key: str, other: str) -> int:
        """Return the side of a slot that faces another one: 1 is right, also within one layer."""
        return -1 if self._layers[other] < self._layers[key] else 1

    def _height(self, box: Box) -> float:
        most = max(len(self._sides.get((box.key, side), ())) for side in (-1, 1))
        return max(box.height, most * PORT + 4.0)

    def _high(self, slot: str) -> float:
        return self._heights.get(slot, _LANE)

    def _sort(self, layer: int) -> None:
        keys, places = self._order[layer], self._places
        means = {key: _mean([places[text] for text in self._beside(key)], places[key]) for key in keys}
        keys.sort(key=means.__getitem__)
        places.update(_shares(keys))

    def _beside(self, slot: str) -> Iterable[str]:
        return sorted(text for text in self._near.get(slot, ()) if self._layers[text] != self._layers[slot])

    def _centers(self) -> dict[str, float]:
        centers: dict[str, float] = {}
        for keys in self._order:
            centers |= self._packed(keys, dict.fromkeys(keys, 0.0))
        for _ in range(_SWEEPS):
            for keys in (*self._order, *reversed(self._order)):
                wanted = {key: _mean([centers[text] for text in self._beside(key)], centers[key]) for key in keys}
                centers |= self._packed(keys, wanted)
        top = min((centers[key] - self._high(key) / 2.0 for key in centers), default=0.0)
        return {key: center - top for key, center in centers.items()}

    def _packed(self, keys: Sequence[str], wanted: Mapping[str, float]) -> dict[str, float]:
        """Return centers apart, as near to the wanted ones from above as from below; boxes without lines come last."""
        joined = [key for key in keys if self._near.get(key)]
        down, up = self._pushed(joined, wanted, 1.0), self._pushed(joined[::-1], wanted, -1.0)
        placed = {key: (down[key] + up[key]) / 2.0 for key in joined}
        bottom = max((placed[key] + self._high(key) / 2.0 + _APART for key in joined), default=0.0)
        for key in keys:
            if key not in placed:
                placed[key] = bottom + self._high(key) / 2.0
                bottom += self._high(key) + _APART
        return placed

    def _pushed(self, keys: Sequence[str], wanted: Mapping[str, float], sign: float) -> dict[str, float]:
        placed: dict[str, float] = {}
        before = ""
        for key in keys:
            place = wanted[key]
            if before:
                apart = _APART if {key, before} & self._heights.keys() else 0.0
                least = placed[before] + sign * ((self._high(before) + self._high(key)) / 2.0 + apart)
                place = max(place, least) if sign > 0.0 else min(place, least)
            placed[key], before = place, key
        return placed

    def _ports(self, centers: Mapping[str, float]) -> Iterator[tuple[tuple[str, int, str], float]]:
        for (key, side), groups in self._sides.items():
            means = {
                group: _mean([centers[other] for other in sorted(others)], 0.0) for group, others in groups.items()
            }
            ordered = sorted(groups, key=means.__getitem__)
            for number, group in enumerate(ordered):
                yield (key, side, group), centers[key] + (number - (len(ordered) - 1) / 2.0) * PORT

    def _route(
        self,
        line: Line,
        chain: Sequence[str],
        centers: Mapping[str, float],
        ports: Mapping[tuple[str, int, str], float],
    ) -> Iterator[Point]:
        for number, slot in enumerate(chain):
            if 0 < number < len(chain) - 1:
                yield from self._through(slot, self._side(slot, chain[number - 1]), centers[slot])
                continue
            side = self._side(slot, chain[1] if number == 0 else chain[-2])
            yield self._edge(slot, side), ports[slot, side, line.group]

    def _through(self, slot: str, side: int, y: float) -> Iterator[Point]:
        yield self._edge(slot, side), y
        yield self._edge(slot, -side), y

    def _edge(self, slot: str, side: int) -> float:
        left = self._columns.lefts[self._layers[slot]]
        return left if side < 0 else left + self._columns.width


def _shares(keys: Sequence[str]) -> Iterator[tuple[str, float]]:
    """Yield how far down its layer each slot is, 0 to 1."""
    return ((key, number / max(1, len(keys) - 1)) for number, key in enumerate(keys))


def _mean(values: Sequence[float], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise
