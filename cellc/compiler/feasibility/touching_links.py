"""Pairs of bodies that need no collision check: they meet in a joint, or never move against each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import Frame

ADJACENT = "Adjacent"
NEVER = "Never"


def touching_links(cell: Cell) -> tuple[tuple[str, str, str], ...]:
    """Return link, link and srdfdom's reason; a pair once, in the order of the frames."""
    pairs: dict[frozenset[str], tuple[str, str, str]] = {}
    for above, name in _adjacent(cell):
        pairs[frozenset((above, name))] = (above, name, ADJACENT)
    for first, second in _rigid(cell):
        pairs.setdefault(frozenset((first, second)), (first, second, NEVER))
    return tuple(pairs.values())


def _solid(cell: Cell) -> frozenset[str]:
    of_devices = (link for device in cell.devices for link in device.body.description.links)
    return frozenset([link.name for link in of_devices if link.collisions] + [box.name for box in cell.scene])


def _adjacent(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield each body with the nearest body above it in the tree."""
    parents = {frame.name: frame.parent for frame in cell.frames}
    solid = _solid(cell)
    for name in (name for name in parents if name in solid):
        above, seen = parents[name], {name}
        while above and above not in solid and above not in seen:
            seen.add(above)
            above = parents.get(above, "")
        if above in solid and above != name:
            yield above, name


def _rigid(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield the bodies between which no joint moves, such as a table and the base that is on it."""
    solid = _solid(cell)
    frames = {frame.name: frame for frame in cell.frames}
    clusters: dict[str, list[str]] = {}
    for name in (frame.name for frame in cell.frames if frame.name in solid):
        clusters.setdefault(_carrier(frames, name), []).append(name)
    for bodies in clusters.values():
        yield from combinations(bodies, 2)


def _carrier(frames: Mapping[str, Frame], name: str) -> str:
    """Return the last frame on the way up before one that moves."""
    seen: set[str] = set()
    while name in frames and not frames[name].moving and frames[name].parent and name not in seen:
        seen.add(name)
        name = frames[name].parent
    return name
