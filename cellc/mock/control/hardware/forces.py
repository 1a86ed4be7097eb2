"""What moves joints that have mass, in place of hardware whose joints are where they are led to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from cellc.mock.control.interfaces import Array


class Forces(Protocol):
    """Drives, masses and contacts of all joints of a cell.

    Cycles that are computed ahead are adopted or void, as those of the hardware are. Where several owners share the
    joints, time goes on in single cycles: who asks first for a time computes it, with what the others asked for before.
    """

    @property
    def shared(self) -> bool:
        """Whether joints have several owners."""
        ...

    def begin(self, positions: Mapping[str, float]) -> None:
        """Let joints be somewhere before anything moves, rad or m."""
        ...

    def aim(self, joints: Sequence[str], targets: Array) -> None:
        """Lead joints in the next cycles, rad or m, shape (cycles, joints); others stay led where they were."""
        ...

    def advance(self, times_ns: NDArray[np.int64]) -> None:
        """Compute where everything is at the times of the next cycles, in simulated ns."""
        ...

    def positions(self, joints: Sequence[str]) -> Array:
        """Return where joints are in the cycles that were computed last, rad or m, shape (cycles, joints)."""
        ...

    def velocities(self, joints: Sequence[str]) -> Array:
        """Return how fast joints are in the cycles that were computed last, rad/s or m/s."""
        ...

    def moving(self, joints: Sequence[str]) -> Array:
        """Return how fast joints are now, rad/s or m/s."""
        ...

    def standing(self, joints: Sequence[str]) -> Array:
        """Return where joints are now, rad or m."""
        ...

    def commit(self, cycles: int) -> None:
        """Adopt the first cycles of what was computed last."""
        ...

    def place(self, joint: str, position: float) -> None:
        """Let somebody move a joint, which is at rest there."""
        ...
