"""Shortcuts of a path of straight edges; every remaining corner costs a standstill."""

from __future__ import annotations

import numpy as np

from cellc.planning.chain import GroupChain
from cellc.planning.edge import edge_is_free
from cellc.planning.limits import Array


def shorten(chain: GroupChain, waypoints: list[Array], *, rng_seed: int, attempts: int) -> list[Array]:
    """Leave out corners, then cut between random places of the path, then leave out corners again.

    Args:
        waypoints: joined by free edges.
        attempts: number of random cuts tried, drawn with ``rng_seed``.
    """
    generator = np.random.default_rng(rng_seed)
    path = _skip_corners(chain, waypoints)
    for _ in range(attempts):
        if len(path) == 2:
            return path
        path = _cut(chain, path, generator)
    return _skip_corners(chain, path)


def _skip_corners(chain: GroupChain, waypoints: list[Array]) -> list[Array]:
    path = [waypoints[0]]
    at = 0
    while at < len(waypoints) - 1:
        ahead = len(waypoints) - 1
        while ahead > at + 1 and not edge_is_free(chain, waypoints[at], waypoints[ahead]):
            ahead -= 1
        path.append(waypoints[ahead])
        at = ahead
    return path


def _cut(chain: GroupChain, path: list[Array], generator: np.random.Generator) -> list[Array]:
    first, second = np.sort(generator.uniform(0.0, len(path) - 1.0, size=2))
    begin, end = int(first), int(second)
    if begin == end:
        return path
    leave, join = _between(path, float(first)), _between(path, float(second))
    if not edge_is_free(chain, leave, join):
        return path
    return [*path[: begin + 1], leave, join, *path[end + 1 :]]


def _between(path: list[Array], place: float) -> Array:
    edge = int(place)
    return path[edge] + (place - edge) * (path[edge + 1] - path[edge])
