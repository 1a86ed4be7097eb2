"""Stored transforms of one edge: static, published with a stamp, or claimed by two nodes."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from typing import Generic, Protocol, TypeVar

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity
from cellc.mock.tf.messages import Outside, TfWarnings, into_the_future, into_the_past, no_data, one_sample, refusal

LATEST = 0
"""A lookup at stamp 0 asks for the latest transform (tf2::TimePointZero)."""

Value = TypeVar("Value")

_UNIT = identity()


class TimeCache(Generic[Value]):
    """Values by stamp, over a bounded time before the newest one.

    ROS 2 accepts a stamp that exists already and keeps the value that arrived last. TF_REPEATED_DATA was a warning of
    ROS 1.
    """

    def __init__(self, buffer_ns: int) -> None:
        self.stamps: list[int] = []
        self.values: list[Value] = []
        self._buffer_ns = buffer_ns

    def insert(self, stamp_ns: int, value: Value) -> bool:
        """Store a value; return False for one that is too old to be kept (TF_OLD_DATA)."""
        stamps = self.stamps
        if stamps and stamp_ns < stamps[-1]:
            if stamp_ns < stamps[-1] - self._buffer_ns:
                return False
            index = bisect_right(stamps, stamp_ns)
            stamps.insert(index, stamp_ns)
            self.values.insert(index, value)
            return True
        stamps.append(stamp_ns)
        self.values.append(value)
        if stamps[0] < stamp_ns - self._buffer_ns:
            first = bisect_left(stamps, stamp_ns - self._buffer_ns)
            del stamps[:first], self.values[:first]
        return True

    def clear(self) -> None:
        """Forget everything."""
        self.stamps.clear()
        self.values.clear()


@dataclass(frozen=True, slots=True)
class Neighbors:
    """The stored transforms around a stamp, as indices; ``after`` is None where one answers alone."""

    before: int
    after: int | None
    fraction: float = 0.0


def find(stamps: Sequence[int], stamp_ns: int) -> Neighbors | Outside:
    """Return the two of the rising stamps to interpolate between for a stamp, or why the lookup fails."""
    if not stamps:
        return no_data()
    if stamp_ns == LATEST or stamp_ns == stamps[-1]:
        return Neighbors(len(stamps) - 1, None)
    if len(stamps) == 1:
        return one_sample(stamp_ns, stamps[0])
    if stamp_ns == stamps[0]:
        return Neighbors(0, None)
    if stamp_ns > stamps[-1]:
        return into_the_future(stamp_ns, stamps[-1])
    if stamp_ns < stamps[0]:
        return into_the_past(stamp_ns, stamps[0])
    after = bisect_right(stamps, stamp_ns)
    before_ns = stamps[after - 1]
    if before_ns == stamp_ns:
        return Neighbors(after - 1, None)
    return Neighbors(after - 1, after, (stamp_ns - before_ns) / (stamps[after] - before_ns))


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


class TransformSource(Protocol):
    """The history of one edge of the tree, child in parent."""

    @property
    def authority(self) -> str:
        """Node that publishes the edge."""
        ...

    def stamps(self) -> Sequence[int] | None:
        """Rising stamps of the stored transforms; None for an edge that holds at all times."""
        ...

    def parent(self, index: int) -> str:
        """Return the frame that a stored transform is given in."""
        ...

    def pose(self, index: int) -> Pose:
        """Return a stored transform."""
        ...

    def clear(self) -> None:
        """Forget what is stored; an edge that holds at all times stays, as in tf2."""
        ...


class StaticSource:
    """An edge of /tf_static: it holds at every time, and no listener forgets it."""

    def __init__(self, parent: str, authority: str, pose: Pose) -> None:
        self.authority = authority
        self._parent = parent
        self._pose = pose

    def stamps(self) -> None:
        """None: valid at all times."""
        return

    def parent(self, index: int) -> str:
        """Return the one parent."""
        return self._parent

    def pose(self, index: int) -> Pose:
        """Return the one pose."""
        return self._pose

    def clear(self) -> None:
        """Nothing: tf2's static cache has nothing to clear."""


class SampledSource:
    """An edge that a node publishes on /tf, as a listener stores it."""

    def __init__(self, parent: str, child: str, authority: str, buffer_s: float, warnings: TfWarnings) -> None:
        """Bind the edge; transforms older than ``buffer_s`` before the newest are forgotten."""
        self.authority = authority
        self._parent = parent
        self._child = child
        self._cache = TimeCache[Pose | DeferredPose](round(buffer_s * 1e9))
        self._warnings = warnings

    def insert(self, stamp_ns: int, pose: Pose | DeferredPose) -> None:
        """Store a transform in the order of stamps, or refuse it with a warning."""
        known = pose.known or _UNIT if isinstance(pose, DeferredPose) else pose
        refused = refusal(self._parent, self._child, self.authority, known)
        if refused is not None:
            self._warnings.note(refused[0], self._child, self.authority, refused[1])
        elif not self._cache.insert(stamp_ns, pose):
            self._warnings.old_data(self._child, self.authority, stamp_ns)

    def stamps(self) -> Sequence[int]:
        """Rising stamps of the stored transforms."""
        return self._cache.stamps

    def parent(self, index: int) -> str:
        """Return the one parent."""
        return self._parent

    def pose(self, index: int) -> Pose:
        """Return a stored transform."""
        stored = self._cache.values[index]
        return stored.get() if isinstance(stored, DeferredPose) else stored

    def clear(self) -> None:
        """Forget what is stored."""
        self._cache.clear()


class DoubledSource:
    """An edge with two authorities: tf2 stores what both say, so that lookups jump from one to the other.

    A transform with a stamp replaces a static one; of two static ones the later stays.
    """

    def __init__(self, first: TransformSource, second: TransformSource) -> None:
        self.authority = f"{first.authority}, {second.authority}"
        self._sources = (first, second)

    def stamps(self) -> Sequence[int] | None:
        """Rising stamps of both together."""
        merged = self._merged()
        return None if merged is None else [stamp for stamp, _, _ in merged]

    def parent(self, index: int) -> str:
        """Return the frame that a stored transform is given in; the authorities may differ."""
        source, own_index = self._locate(index)
        return source.parent(own_index)

    def pose(self, index: int) -> Pose:
        """Return a stored transform of either authority."""
        source, own_index = self._locate(index)
        return source.pose(own_index)

    def clear(self) -> None:
        """Forget what both have sent."""
        for source in self._sources:
            source.clear()

    def _locate(self, index: int) -> tuple[TransformSource, int]:
        merged = self._merged()
        if merged is None:
            return next(source for source in reversed(self._sources) if source.stamps() is None), 0
        _, number, own_index = merged[index]
        return self._sources[number], own_index

    def _merged(self) -> list[tuple[int, int, int]] | None:
        """Return stamp, number of the source and index there, of all stored transforms; None where static ones hold."""
        stamps = [source.stamps() for source in self._sources]
        entries = sorted(
            (stamp, number, index) for number, each in enumerate(stamps) for index, stamp in enumerate(each or ())
        )
        return entries if entries or None not in stamps else None
