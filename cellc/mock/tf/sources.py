"""Where transforms come from: static edges, edges that a node publishes with a stamp, and edges that two claim."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from cellc.mock.tf.cache import TimeCache
from cellc.mock.tf.deferred import DeferredPose
from cellc.mock.tf.warnings import TfWarnings, refusal
from cellc.transforms import Pose, identity

_UNIT = identity()


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
