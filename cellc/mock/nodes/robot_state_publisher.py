"""robot_state_publisher: turns joint states into transforms of the moving links."""

from __future__ import annotations

import bisect
from collections.abc import Iterable, Mapping

import numpy as np

from cellc.mock.tf.buffer import TransformBuffer
from cellc.mock.tf.sources import StaticSource
from cellc.mock.world.joint_states import JointStateHistory
from cellc.mock.world.links import LinkJoint, LinkTree
from cellc.transforms import Pose, interpolate

NODE = "robot_state_publisher"
PUBLISH_FREQUENCY_HZ = 20.0
"""Default of the parameter `publish_frequency`: /tf is slower than the joint states it comes from."""


class PublishedStates:
    """The joint states of one broadcaster that robot_state_publisher turned into transforms.

    Joint states are thinned as the node does it: one is used when its stamp is an interval after the last used one.
    Poses are computed when they are asked for.
    """

    def __init__(self, history: JointStateHistory, rate_hz: float, buffer_s: float) -> None:
        self.history = history
        self.stamps: list[int] = []
        self.rows: list[tuple[float, ...]] = []
        self._interval_ns = round(1e9 / rate_hz)
        self._buffer_ns = round(buffer_s * 1e9)

    def catch_up(self, now_ns: int) -> None:
        """Use the joint states that have arrived since the last call."""
        arrived = self.history.arrived(now_ns)
        stamps = self.history.stamps[:arrived]
        index = 0 if not self.stamps else int(np.searchsorted(stamps, self.stamps[-1] + self._interval_ns))
        while index < arrived:
            self.stamps.append(int(stamps[index]))
            self.rows.append(tuple(self.history.positions[index].tolist()))
            index = int(np.searchsorted(stamps, self.stamps[-1] + self._interval_ns))
        if self.stamps:
            first = bisect.bisect_left(self.stamps, self.stamps[-1] - self._buffer_ns)
            del self.stamps[:first], self.rows[:first]

    def positions(self, index: int) -> Mapping[str, float]:
        """Return the joint positions of one used message."""
        return dict(zip(self.history.names, self.rows[index], strict=True))


class JointSource:
    """The transform of a link that moves with a joint, published until ``dropped_at_ns``."""

    authority = NODE

    def __init__(self, joint: LinkJoint, published: PublishedStates) -> None:
        self.parent = joint.parent
        self.dropped_at_ns: int | None = None
        self._joint = joint
        self._published = published

    def span_ns(self) -> tuple[int, int] | None:
        """First and last stamp in the buffer; callers ask ``has_data`` first."""
        count = self._count()
        return (self._published.stamps[0], self._published.stamps[count - 1])

    def has_data(self) -> bool:
        """Tell whether joint states of this joint were ever received."""
        followed = self._joint.follows or self._joint.name
        return followed in self._published.history.names and self._count() > 0

    def at(self, stamp_ns: int) -> Pose:
        """Interpolate the pose of the link between published transforms, as a listener does."""
        stamps = self._published.stamps
        index = bisect.bisect_left(stamps, stamp_ns)
        after = self._joint.pose(self._published.positions(index))
        if stamps[index] == stamp_ns:
            return after
        before = self._joint.pose(self._published.positions(index - 1))
        span = stamps[index] - stamps[index - 1]
        return interpolate(before, after, (stamp_ns - stamps[index - 1]) / span)

    def _count(self) -> int:
        if self.dropped_at_ns is None:
            return len(self._published.stamps)
        return bisect.bisect_left(self._published.stamps, self.dropped_at_ns)


class RobotStatePublisher:
    """Publishes every edge of the URDF: fixed ones latched on /tf_static, moving ones from joint states on /tf."""

    def __init__(
        self, links: LinkTree, histories: Iterable[JointStateHistory], rate_hz: float, buffer_s: float
    ) -> None:
        """Bind the node; a joint is taken from the first broadcaster that reports it."""
        self._links = links
        self._published = tuple(PublishedStates(history, rate_hz, buffer_s) for history in histories)
        self._moving: dict[str, JointSource] = {}

    def announce(self, buffer: TransformBuffer, *, hears_static: bool, hears_moving: bool) -> None:
        """Start publishing to a listener; the names of the joints must be known from a first joint state.

        Args:
            hears_static: the listener is connected on /tf_static.
            hears_moving: the listener is connected on /tf.
        """
        for child, joint in self._links.joints.items():
            source = self._source_of(joint)
            if source is not None and (hears_moving if joint.moves else hears_static):
                buffer.add(child, source)

    def catch_up(self, now_ns: int) -> None:
        """Publish what the joint states that have arrived by now imply."""
        for published in self._published:
            published.catch_up(now_ns)

    def drop(self, child: str, now_ns: int) -> bool:
        """Stop publishing a moving link; tell whether there is one of this name."""
        source = self._moving.get(child)
        if source is not None:
            source.dropped_at_ns = now_ns
        return source is not None

    def resume(self, child: str) -> None:
        """Publish a dropped link again."""
        if child in self._moving:
            self._moving[child].dropped_at_ns = None

    def _source_of(self, joint: LinkJoint) -> StaticSource | JointSource | None:
        if not joint.moves:
            return StaticSource(joint.parent, NODE, joint.origin)
        followed = joint.follows or joint.name
        for published in self._published:
            if followed in published.history.names:
                self._moving[joint.child] = JointSource(joint, published)
                return self._moving[joint.child]
        return None
