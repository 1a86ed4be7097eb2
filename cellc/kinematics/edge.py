"""Collision checks along straight edges in joint space."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cellc.kinematics.chain import GroupChain
from cellc.kinematics.limits import Array

# Largest step of any joint between two checked configurations: turned alone, a joint moves a tip 1 m away by 10 mm from
# one check to the next, so that no point is farther than 5 mm from a place where it was checked.
EDGE_RESOLUTION_RAD = 0.01


def edge_is_free(chain: GroupChain, start: Array, goal: Array, resolution: float = EDGE_RESOLUTION_RAD) -> bool:
    """Tell whether the inside and the goal of an edge are free of collision; the start is taken as checked.

    Args:
        resolution: largest step of any joint between two checks, rad or metres.
    """
    count = max(1, math.ceil(float(np.max(np.abs(goal - start))) / resolution))
    difference = (goal - start) / count
    return not any(chain.collides(start + step * difference) for step in _coarse_first(count))


def _coarse_first(count: int) -> Iterator[int]:
    """Yield 1 to ``count``, the goal first, then ever finer: an obstacle is met early wherever it is."""
    stride = 1 << (count.bit_length() - 1)
    yield count
    while stride >= 1:
        yield from range(stride, count, 2 * stride)
        stride //= 2
