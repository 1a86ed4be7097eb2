"""The transform buffer of a listener: looked up at a stamp, interpolated, bounded, never extrapolated.

Walks the tree as tf2::BufferCore does, so that of several reasons it names the same one.
"""

from __future__ import annotations

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity, interpolate
from cellc.mock.clocks import TimeJump
from cellc.mock.tf.messages import (
    Outside,
    TfFailure,
    TfWarnings,
    loop,
    no_data,
    not_connected,
    refused_name,
    unknown_frame,
)
from cellc.mock.tf.sources import LATEST, DoubledSource, Neighbors, TransformSource, find

DEFAULT_BUFFER_S = 10.0
"""tf2::BUFFER_CORE_DEFAULT_CACHE_TIME."""
MAX_DEPTH = 1000
"""tf2::BufferCore::MAX_GRAPH_DEPTH."""


@dataclass(frozen=True, slots=True)
class Transform:
    """A successful lookup: the pose of the source frame in the target frame at a stamp."""

    target: str
    source: str
    stamp_ns: int
    pose: Pose


@dataclass(frozen=True, slots=True)
class Edge:
    """A frame in its parent at the stamp of a lookup."""

    parent: str
    pose: Pose


class TransformBuffer:
    """All edges that a listener has heard of.

    Attributes:
        conflicts: second authorities, one line for each; tf2 stores what both say and complains of nothing.
        warnings: what the listener logs.
    """

    def __init__(self) -> None:
        self.conflicts: list[str] = []
        self.warnings = TfWarnings()
        self._sources: dict[str, TransformSource] = {}
        self._authorities: dict[str, list[str]] = {}
        self._remembered: set[str] = set()

    def add(self, child: str, source: TransformSource) -> None:
        """Listen to a publisher of a child frame; a second publisher of one child is a conflict."""
        self._authorities.setdefault(child, []).append(source.authority)
        present = self._sources.get(child)
        if present is not None:
            self.conflicts.append(
                f"frame `{child}` has two authorities: `{present.authority}` and `{source.authority}`"
            )
            source = DoubledSource(present, source)
        self._sources[child] = source

    def note_jump(self, jump: TimeJump) -> None:
        """Clear the buffer where tf2 does: on a new source of time, and on a step back of /clock.

        A step of the system's own clock goes unnoticed: rcl calls back for time from /clock alone (rcl `time.c`).
        """
        if jump.source_changed:
            self._clear("Detected time source change.")
        elif jump.clock.simulated and jump.delta_ns < 0:
            self._clear("Detected jump back in time.")

    def lookup(self, target: str, source: str, stamp_ns: int) -> Transform | TfFailure:
        """Return the pose of ``source`` in ``target`` at ``stamp_ns``, 0 for the latest; or why it is missing."""
        if target == source:
            return Transform(target, source, stamp_ns, identity())
        failure = self._refused(target, source)
        if failure is not None:
            return failure
        if stamp_ns == LATEST:
            stamp_ns = self.latest_ns(target, source) or LATEST
        return self._walk(target, source, stamp_ns)

    def path(self, target: str, source: str) -> tuple[str, ...]:
        """Return the child frames of all edges between two frames, those that are not published included."""
        from_source, from_target = self._to_root(source), self._to_root(target)
        return tuple(sorted(set(from_source) ^ set(from_target)))

    def authorities(self, child: str) -> tuple[str, ...]:
        """Return who publishes a frame; more than one is a conflict."""
        return tuple(self._authorities.get(child, ()))

    def latest_ns(self, target: str, source: str) -> int | None:
        """Return the last stamp at which every edge between two frames is known; None where none limits it."""
        return min(self.ends(target, source).values(), default=None)

    def ends(self, target: str, source: str) -> dict[str, int]:
        """Return the last stamp of each edge between two frames, by its child; without those that always hold."""
        ends: dict[str, int] = {}
        for child in self.path(target, source):
            edge = self._sources.get(child)
            stamps = None if edge is None else edge.stamps()
            if stamps:
                ends[child] = stamps[-1]
        return ends

    def _clear(self, reason: str) -> None:
        self._remembered |= self._known_frames()
        self.warnings.cleared(reason, "")
        for source in self._sources.values():
            source.clear()

    def _refused(self, target: str, source: str) -> TfFailure | None:
        """Return why a frame of a lookup cannot be looked for, the target's reason first."""
        for argument, frame in (("target_frame", target), ("source_frame", source)):
            failure = refused_name(argument, frame)
            if failure is None and not self._knows(frame):
                failure = unknown_frame(argument, frame)
            if failure is not None:
                return failure
        return None

    def _walk(self, target: str, source: str, stamp_ns: int) -> Transform | TfFailure:
        """Walk up from the source as far as transforms are known, then up from the target until that frame is met."""
        up: list[Pose] = []
        top, missing = source, None
        while (edge := self._edge(top, stamp_ns)) is not None:
            if isinstance(edge, Outside):
                missing = edge  # the walk up from the target may meet this frame all the same
                break
            if top == target:
                return Transform(target, source, stamp_ns, _compose(up))
            up.append(edge.pose)
            top = edge.parent
            if len(up) > MAX_DEPTH:
                return loop()
        down: list[Pose] = []
        frame = target
        while frame != top and (edge := self._edge(frame, stamp_ns)) is not None:
            if isinstance(edge, Outside):
                return edge.between(target, source)
            if frame == source:
                return Transform(target, source, stamp_ns, _compose(down).inverse())
            down.append(edge.pose)
            frame = edge.parent
            if len(down) > MAX_DEPTH:
                return loop()
        if frame != top:
            return not_connected(target, source) if missing is None else missing.between(target, source)
        return Transform(target, source, stamp_ns, _compose(down).inverse() @ _compose(up))

    def _edge(self, child: str, stamp_ns: int) -> Edge | Outside | None:
        """Return a frame in its parent at a stamp; None for a frame that has no parent."""
        source = self._sources.get(child)
        if source is None:
            return None
        stamps = source.stamps()
        if stamps is None:
            return Edge(source.parent(0), source.pose(0))
        if not stamps:
            return no_data() if child in self._remembered else None
        neighbors = find(stamps, stamp_ns)
        if isinstance(neighbors, Outside):
            return neighbors
        return _between(source, neighbors)

    def _knows(self, frame: str) -> bool:
        """Tell whether a frame was ever heard of, as a child or as a parent."""
        source = self._sources.get(frame)
        if frame in self._remembered or (source is not None and _has_data(source)):
            return True
        return any(each.parent(-1) == frame for each in self._sources.values() if _has_data(each))

    def _known_frames(self) -> set[str]:
        known = set(self._remembered)
        for child, source in self._sources.items():
            if _has_data(source):
                known |= {child, source.parent(-1)}
        return known

    def _to_root(self, frame: str) -> list[str]:
        chain = [frame]
        while (source := self._sources.get(chain[-1])) is not None:
            stamps = source.stamps()
            if (stamps is not None and not stamps) or source.parent(-1) in chain:
                break
            chain.append(source.parent(-1))
        return chain


def _has_data(source: TransformSource) -> bool:
    stamps = source.stamps()
    return stamps is None or bool(stamps)


def _between(source: TransformSource, found: Neighbors) -> Edge:
    """Return the edge at a place between stored transforms; those of different parents are not mixed."""
    parent, pose = source.parent(found.before), source.pose(found.before)
    if found.after is None or source.parent(found.after) != parent:
        return Edge(parent, pose)
    return Edge(parent, interpolate(pose, source.pose(found.after), found.fraction))


def _compose(poses: list[Pose]) -> Pose:
    """Return the pose of the first child in the parent of the last one."""
    composed = identity()
    for pose in poses:
        composed = pose @ composed
    return composed
