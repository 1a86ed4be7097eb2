"""How many processes pay for the specs of one call."""

from __future__ import annotations

import os
from collections.abc import Mapping

from cellc.batch.compute import Kind

MOST_WORKERS = 8

# A process loads the compiler first, which takes as long as checking so many cells or compiling so many.
_CELLS_THAT_PAY: Mapping[Kind, int] = {"check": 16, "compile": 3}


def number_of_workers(kind: Kind, cells: int, cores: int | None = None) -> int:
    """Return how many processes pay for so many cells; 1 is this process.

    Args:
        cores: as many as the system lets this process use, if None.
    """
    available = usable_cores() if cores is None else cores
    return max(1, min(available, cells // _CELLS_THAT_PAY[kind], MOST_WORKERS))


def usable_cores() -> int:
    """Return the number of cores that the system lets this process use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1
