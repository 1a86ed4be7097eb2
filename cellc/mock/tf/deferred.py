"""A pose that nobody may ever look at."""

from __future__ import annotations

from collections.abc import Callable

from cellc.transforms import Pose


class DeferredPose:
    """A pose that is computed when it is asked for first, from what was known when it was made."""

    __slots__ = ("_compute", "_pose")

    def __init__(self, compute: Callable[[], Pose]) -> None:
        """Bind a computation that gives the same pose whenever it is done, one that tf2 does not refuse."""
        self._compute = compute
        self._pose: Pose | None = None

    @property
    def known(self) -> Pose | None:
        """The pose where it was computed already."""
        return self._pose

    def get(self) -> Pose:
        """Return the pose."""
        if self._pose is None:
            self._pose = self._compute()
        return self._pose
