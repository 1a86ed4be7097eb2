"""Where transforms come from: static edges, and edges that a node publishes with a stamp."""

from __future__ import annotations

from bisect import bisect_left
from typing import Protocol

from cellc.transforms import Pose, interpolate


class TransformSource(Protocol):
    """The history of one edge of the tree, child in parent."""

    @property
    def parent(self) -> str:
        """Frame that the pose is given in."""
        ...

    @property
    def authority(self) -> str:
        """Node that publishes the edge."""
        ...

    def span_ns(self) -> tuple[int, int] | None:
        """First and last stamp; None for an edge that holds at all times."""
        ...

    def has_data(self) -> bool:
        """Tell whether anything was ever received."""
        ...

    def at(self, stamp_ns: int) -> Pose:
        """Return the pose at a stamp inside the span."""
        ...


class StaticSource:
    """An edge of /tf_static: it holds at every time, and no listener forgets it."""

    def __init__(self, parent: str, authority: str, pose: Pose) -> None:
        self.parent = parent
        self.authority = authority
        self._pose = pose

    def span_ns(self) -> tuple[int, int] | None:
        """None: valid at all times."""
        return None

    def has_data(self) -> bool:
        """True: latched."""
        return True

    def at(self, stamp_ns: int) -> Pose:
        """Return the one pose."""
        return self._pose


class SampledSource:
    """An edge that a node publishes on /tf; samples older than the buffer are forgotten.

    Attributes:
        repeated: samples refused because their stamp was already there (tf2: TF_REPEATED_DATA).
        too_old: samples refused because they were older than the buffer (tf2: TF_OLD_DATA).
    """

    def __init__(self, parent: str, authority: str, buffer_s: float) -> None:
        self.parent = parent
        self.authority = authority
        self.repeated = 0
        self.too_old = 0
        self._buffer_ns = round(buffer_s * 1e9)
        self._stamps: list[int] = []
        self._poses: list[Pose] = []

    def insert(self, stamp_ns: int, pose: Pose) -> None:
        """Store a sample in the order of stamps."""
        if self._stamps and stamp_ns < self._stamps[-1] - self._buffer_ns:
            self.too_old += 1
            return
        index = bisect_left(self._stamps, stamp_ns)
        if index < len(self._stamps) and self._stamps[index] == stamp_ns:
            self.repeated += 1
            return
        self._stamps.insert(index, stamp_ns)
        self._poses.insert(index, pose)
        first = bisect_left(self._stamps, self._stamps[-1] - self._buffer_ns)
        del self._stamps[:first], self._poses[:first]

    def span_ns(self) -> tuple[int, int] | None:
        """First and last stamp that is kept; callers ask ``has_data`` first."""
        return (self._stamps[0], self._stamps[-1])

    def has_data(self) -> bool:
        """Tell whether a sample is kept."""
        return bool(self._stamps)

    def at(self, stamp_ns: int) -> Pose:
        """Interpolate between the neighbours of a stamp inside the span."""
        index = bisect_left(self._stamps, stamp_ns)
        if self._stamps[index] == stamp_ns:
            return self._poses[index]
        before, after = self._stamps[index - 1], self._stamps[index]
        return interpolate(self._poses[index - 1], self._poses[index], (stamp_ns - before) / (after - before))
