"""Collision checks along straight edges in joint space."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from cellc.planning.chain import GroupChain
from cellc.planning.limits import Array

# No point of the cell moves farther between two checked configurations, so none is farther than half of it from a place
# where it was checked.
EDGE_RESOLUTION_M = 0.01
# Where a bound is as large as the axis of a transport unit, the checks are no closer than this.
_LEAST_STEP_RAD = 0.001


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
