"""The transform buffer of a listener: looked up at a stamp, interpolated, bounded, never extrapolated."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.tf.failure import TfFailure, TfFailureKind, extrapolation, not_connected, unknown_frame
from cellc.mock.tf.sources import TransformSource
from cellc.transforms import Pose, identity

DEFAULT_BUFFER_S = 10.0
"""tf2::BUFFER_CORE_DEFAULT_CACHE_TIME."""


@dataclass(frozen=True, slots=True)
class Transform:
    """A successful lookup: the pose of the source frame in the target frame at a stamp."""

    target: str
    source: str
    stamp_ns: int
    pose: Pose


class TransformBuffer:
    """All edges that a listener has heard of, one authority for each child frame.

    Attributes:
        conflicts: second authorities, one line for each; the first one keeps the frame.
    """

    def __init__(self) -> None:
        self.conflicts: list[str] = []
        self._sources: dict[str, TransformSource] = {}

    def add(self, child: str, source: TransformSource) -> None:
        """Bind a child frame to its publisher; a second publisher of one child is a conflict and is not heard."""
        present = self._sources.get(child)
        if present is not None:
            self.conflicts.append(
                f"frame `{child}` has two authorities: `{present.authority}` and `{source.authority}`"
            )
            return
        self._sources[child] = source

    def lookup(self, target: str, source: str, stamp_ns: int) -> Transform | TfFailure:
        """Return the pose of ``source`` in ``target`` at ``stamp_ns``, or why there is none."""
        known = self._known_frames()
        for argument, frame in (("target_frame", target), ("source_frame", source)):
            if frame not in known:
                return unknown_frame(argument, frame)
        from_source, from_target = self._to_root(source), self._to_root(target)
        common = next((frame for frame in from_source if frame in from_target), None)
        if common is None:
            return not_connected(target, source)
        up = from_source[: from_source.index(common)]
        down = from_target[: from_target.index(common)]
        failure = self._outside((*up, *down), stamp_ns, target, source)
        if failure is not None:
            return failure
        pose = self._compose(down, stamp_ns).inverse() @ self._compose(up, stamp_ns)
        return Transform(target, source, stamp_ns, pose)

    def path(self, target: str, source: str) -> tuple[str, ...]:
        """Return the child frames of all edges between two frames, those that are not published included."""
        from_source, from_target = self._to_root(source), self._to_root(target)
        return tuple(sorted(set(from_source) ^ set(from_target)))

    def latest_ns(self, target: str, source: str) -> int | None:
        """Return the last stamp at which every edge between two frames is known; None where none limits it."""
        ends: list[int] = []
        for child in self.path(target, source):
            edge = self._sources.get(child)
            span = edge.span_ns() if edge is not None and edge.has_data() else None
            if span is not None:
                ends.append(span[1])
        return min(ends) if ends else None

    def _known_frames(self) -> set[str]:
        heard = {child: edge for child, edge in self._sources.items() if edge.has_data()}
        return {*heard, *(edge.parent for edge in heard.values())}

    def _to_root(self, frame: str) -> list[str]:
        chain = [frame]
        while (edge := self._sources.get(chain[-1])) is not None and edge.has_data() and edge.parent not in chain:
            chain.append(edge.parent)
        return chain

    def _outside(self, children: tuple[str, ...], stamp_ns: int, target: str, source: str) -> TfFailure | None:
        for child in children:
            span = self._sources[child].span_ns()
            if span is None:
                continue
            if stamp_ns > span[1]:
                return extrapolation(TfFailureKind.EXTRAPOLATION_FUTURE, stamp_ns, span[1], target, source)
            if stamp_ns < span[0]:
                return extrapolation(TfFailureKind.EXTRAPOLATION_PAST, stamp_ns, span[0], target, source)
        return None

    def _compose(self, children: list[str], stamp_ns: int) -> Pose:
        """Return the pose of the first child in the parent of the last one."""
        pose = identity()
        for child in children:
            pose = self._sources[child].at(stamp_ns) @ pose
        return pose
