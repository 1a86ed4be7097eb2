"""What is near a place, found without a look at everything: a hall has thousands of frames."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import product
from typing import Generic, TypeVar

from cellc.contract.transforms import Vector3

_Thing = TypeVar("_Thing")
_MOST_STEPS = 2
"""From here on all cubes are looked at, rather than those around a place."""


class Neighbors(Generic[_Thing]):
    """Things with their places, sorted into cubes."""

    def __init__(self, things: Iterable[tuple[Vector3, _Thing]], edge_m: float) -> None:
        """Sort things into cubes of an edge: about the distance within which they are looked for, m."""
        self._edge_m = edge_m
        self._cubes: dict[tuple[int, ...], list[tuple[Vector3, _Thing]]] = {}
        for place, thing in things:
            self._cubes.setdefault(self._cube(place), []).append((place, thing))

    def within(self, distance_m: float, of: Vector3) -> list[tuple[Vector3, _Thing]]:
        """Return the things that are at most a distance from a place, m, those of a cube together."""
        cubes = (self._cubes.get(cube, ()) for cube in self._around(distance_m, of))
        return [(place, thing) for things in cubes for place, thing in things if math.dist(place, of) <= distance_m]

    def take(self, distance_m: float, of: Vector3) -> list[tuple[Vector3, _Thing]]:
        """Return these things, and find them no more."""
        taken = self.within(distance_m, of)
        for cube in dict.fromkeys(self._cube(place) for place, _ in taken):
            self._cubes[cube] = [each for each in self._cubes[cube] if math.dist(each[0], of) > distance_m]
        return taken

    def _around(self, distance_m: float, of: Vector3) -> Iterable[tuple[int, ...]]:
        """Return the cubes in which a thing can be so near."""
        if distance_m > _MOST_STEPS * self._edge_m:
            return list(self._cubes)
        steps = math.ceil(distance_m / self._edge_m)
        x, y, z = self._cube(of)
        way = range(-steps, steps + 1)
        return [(x + along, y + across, z + up) for along, across, up in product(way, repeat=3)]

    def _cube(self, place: Vector3) -> tuple[int, ...]:
        return tuple([math.floor(coordinate / self._edge_m) for coordinate in place])
