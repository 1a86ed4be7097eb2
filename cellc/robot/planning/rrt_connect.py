"""RRT-Connect (Kuffner and LaValle, ICRA 2000) with a given seed and a bounded number of iterations.

The path is a chain of straight edges in joint space, checked for collision at a bounded resolution, and shortened
afterwards: every corner that remains costs a standstill.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cellc.robot.planning.chain import GroupChain
from cellc.robot.planning.problem import Array, JointLimits

_EXTENSION_RAD = 0.5
# No point of the cell moves farther between two checked configurations, so none is farther than half of it from a place
# where it was checked.
EDGE_RESOLUTION_M = 0.01
# Where a bound is as large as the axis of a transport unit, the checks are no closer than this.
_LEAST_STEP_RAD = 0.001


class _Tree:
    """Configurations reached from one root, and the node from which each was reached."""

    def __init__(self, root: Array) -> None:
        self.nodes = root[np.newaxis, :].copy()
        self.parents = [-1]

    def nearest(self, configuration: Array) -> int:
        return int(np.argmin(np.sum((self.nodes - configuration) ** 2, axis=1)))

    def add(self, configuration: Array, parent: int) -> int:
        self.nodes = np.vstack((self.nodes, configuration))
        self.parents.append(parent)
        return len(self.parents) - 1

    def branch(self, node: int) -> list[Array]:
        """Return the configurations from the root to a node."""
        configurations: list[Array] = []
        while node >= 0:
            configurations.append(self.nodes[node])
            node = self.parents[node]
        return configurations[::-1]


def connect(
    chain: GroupChain, limits: JointLimits, start: Array, goal: Array, *, rng_seed: int, max_iterations: int
) -> list[Array] | None:
    """Grow a tree from each end until they meet.

    Returns:
        The waypoints from start to goal, both included, joined by free edges; None where the iterations are used up.
    """
    generator = np.random.default_rng(rng_seed)
    lower, upper = _sampling_range(limits, start, goal)
    trees = (_Tree(start), _Tree(goal))
    for iteration in range(max_iterations):
        growing, waiting = trees[iteration % 2], trees[1 - iteration % 2]
        node = _extend(chain, growing, generator.uniform(lower, upper))
        if node is None:
            continue
        met = _reach(chain, waiting, growing.nodes[node])
        if met is None:
            continue
        first, second = (node, met) if iteration % 2 == 0 else (met, node)
        return trees[0].branch(first) + trees[1].branch(second)[-2::-1]
    return None


def _sampling_range(limits: JointLimits, start: Array, goal: Array) -> tuple[Array, Array]:
    # A joint of several turns needs no more than half a turn around the two ends.
    lower = np.maximum(limits.lower, np.minimum(start, goal) - math.pi)
    upper = np.minimum(limits.upper, np.maximum(start, goal) + math.pi)
    return lower, upper


def _extend(chain: GroupChain, tree: _Tree, target: Array) -> int | None:
    """Grow a tree by at most one extension towards a configuration; return the new node, None where it is blocked."""
    near = tree.nearest(target)
    difference = target - tree.nodes[near]
    length = float(np.max(np.abs(difference)))
    fresh = target if length <= _EXTENSION_RAD else tree.nodes[near] + difference * (_EXTENSION_RAD / length)
    return tree.add(fresh, near) if edge_is_free(chain, tree.nodes[near], fresh) else None


def _reach(chain: GroupChain, tree: _Tree, target: Array) -> int | None:
    """Grow a tree until it contains a configuration; return its node, None where the way is blocked."""
    while True:
        node = _extend(chain, tree, target)
        if node is None or bool(np.all(tree.nodes[node] == target)):
            return node


def edge_is_free(chain: GroupChain, start: Array, goal: Array) -> bool:
    """Tell whether the inside and the goal of an edge are free of collision; the start is taken as checked."""
    count = max(1, math.ceil(check_lengths(chain, (goal - start)[np.newaxis, :])[0]))
    order = np.fromiter(_coarse_first(count), dtype=np.float64, count=count)
    return chain.first_collision(start + order[:, np.newaxis] * ((goal - start) / count)) is None


def check_lengths(chain: GroupChain, differences: Array) -> Array:
    """Return the lengths of edges in units of the farthest that two checks may be apart.

    Args:
        differences: of configurations, one in each row.
    """
    wanted = chain.sweeps_m(differences) / EDGE_RESOLUTION_M
    return np.asarray(np.minimum(wanted, np.max(np.abs(differences), axis=1) / _LEAST_STEP_RAD))


def _coarse_first(count: int) -> Iterator[int]:
    """Yield 1 to ``count``, the goal first, then ever finer: an obstacle is met early wherever it is."""
    stride = 1 << (count.bit_length() - 1)
    yield count
    while stride >= 1:
        yield from range(stride, count, 2 * stride)
        stride //= 2


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
