"""RRT-Connect (Kuffner and LaValle, ICRA 2000) with a told seed and a bounded number of iterations."""

from __future__ import annotations

import math

import numpy as np

from cellc.planning.chain import GroupChain
from cellc.planning.edge import edge_is_free
from cellc.planning.limits import Array, JointLimits

_EXTENSION_RAD = 0.5


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
        found: list[Array] = []
        while node >= 0:
            found.append(self.nodes[node])
            node = self.parents[node]
        return found[::-1]


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
