"""robot_state_publisher: turns the joint states that reach it into transforms of the moving links."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.mock.bus.stream import NEVER_NS, IntArray, StreamEdge
from cellc.mock.clocks import Clock, Clocks
from cellc.mock.tf.buffer import TransformBuffer
from cellc.mock.tf.messages import TfWarnings
from cellc.mock.tf.sources import StaticSource, TimeCache
from cellc.mock.world.joint_states import JointStateHistory
from cellc.mock.world.world import LinkJoint, LinkTree

NODE = "robot_state_publisher"
PUBLISH_FREQUENCY_HZ = 20.0
"""Default of the parameter `publish_frequency`: /tf is slower than the joint states it comes from."""


class JointStateFeed:
    """What has reached a node of the joint states that a broadcaster published."""

    def __init__(self, history: JointStateHistory, edge: StreamEdge | None) -> None:
        """Bind a subscriber; ``edge`` is None where the contract describes no connection, which then is ideal."""
        self.history = history
        self._edge = edge

    @property
    def undelayed(self) -> bool:
        """Tell whether every message so far arrived as it was published."""
        return (self._edge is None or self._edge.ideal) and not self.history.is_delayed

    def newest(self, now_ns: int) -> int | None:
        """Return the place in the history of the newest message that has arrived; None before the first."""
        if self._edge is None or self._edge.ideal:
            count = self.history.arrived(now_ns)
            return count - 1 if count else None
        here = self.arrived(now_ns)
        return int(here[-1]) if here.size else None

    def newest_arrival_ns(self, now_ns: int) -> int | None:
        """Return when the newest message arrived that has; None before the first."""
        newest = self.newest(now_ns)
        if newest is None:
            return None
        stamps = self.history.stamps
        if self._edge is None or self._edge.ideal:
            return int(self.history.arrivals(stamps[newest : newest + 1])[0])
        delayed = self.history.arrivals(stamps) - stamps
        return int((self._edge.arrivals(stamps) + delayed)[newest])

    def last_arrivals(self, count: int) -> IntArray:
        """Return when the last messages of the history arrive; `NEVER_NS` or later represents one that is lost."""
        stamps = self.history.stamps
        arrivals = self.history.arrivals(stamps[-count:])
        if self._edge is None or self._edge.ideal:
            return arrivals
        return self._edge.arrivals(stamps)[-count:] + (arrivals - stamps[-count:])

    def arrived(self, now_ns: int) -> IntArray:
        """Return the places in the history of all messages that have arrived, rising."""
        stamps = self.history.stamps
        if self._edge is None or self._edge.ideal:
            if not self.history.is_delayed:
                return np.arange(self.history.arrived(now_ns), dtype=np.int64)
            return np.flatnonzero(self.history.arrivals(stamps) <= now_ns)
        delayed = self.history.arrivals(stamps) - stamps
        return np.flatnonzero(self._edge.arrivals(stamps) + delayed <= now_ns)


@dataclass(frozen=True, slots=True)
class UsedState:
    """A joint state that became transforms: the simulated instant of its stamp, and the positions."""

    taken_ns: int
    positions: tuple[float, ...]


class PublishedStates:
    """The joint states of one broadcaster that robot_state_publisher turned into transforms.

    Joint states are thinned as the node does it: one is used when its stamp is an interval after the last used one.
    The transforms carry the stamp of the joint state, made on the clock of its broadcaster. Poses are computed when
    they are asked for.
    """

    def __init__(
        self, feed: JointStateFeed, rate_hz: float, buffer_s: float, clock: Clock, edge: StreamEdge | None
    ) -> None:
        """Bind the states of a broadcaster that stamps with ``clock``; ``edge`` takes transforms to the listener."""
        self.history = feed.history
        self.cache = TimeCache[UsedState](round(buffer_s * 1e9))
        self.refused_stamps: list[int] = []
        self._interval_ns = round(1e9 / rate_hz)
        self._feed = feed
        self._clock = clock
        self._edge = edge
        self._travelling: list[tuple[int, UsedState]] = []
        self._last_ns: int | None = None

    @property
    def undelayed(self) -> bool:
        """Tell whether every message so far arrived as it was published, here and at the listener."""
        return self._feed.undelayed and (self._edge is None or self._edge.ideal)

    def catch_up(self, now_ns: int) -> None:
        """Use the joint states that have arrived since the last call."""
        places = self._feed.arrived(now_ns)
        stamps = self.history.stamps[places]
        index = 0 if self._last_ns is None else int(stamps.searchsorted(self._last_ns + self._interval_ns))
        while index < len(stamps):
            taken_ns = int(stamps[index])
            self._publish(UsedState(taken_ns, tuple(self.history.positions[places[index]].tolist())))
            self._last_ns = taken_ns
            index = int(stamps.searchsorted(taken_ns + self._interval_ns))
        if self._travelling:
            self._receive(now_ns)

    def _publish(self, used: UsedState) -> None:
        if self._edge is None or self._edge.ideal:
            self._store(used)
            return
        arrival_ns = int(self._edge.arrivals(np.array([used.taken_ns], dtype=np.int64))[0])
        if arrival_ns < NEVER_NS:
            self._travelling.append((arrival_ns, used))

    def _receive(self, now_ns: int) -> None:
        """Store the transforms that have reached the listener."""
        for arrival_ns, used in self._travelling:
            if arrival_ns <= now_ns:
                self._store(used)
        self._travelling = [entry for entry in self._travelling if entry[0] > now_ns]

    def _store(self, used: UsedState) -> None:
        stamp_ns = self._clock.read(used.taken_ns)
        if not self.cache.insert(stamp_ns, used):
            self.refused_stamps.append(stamp_ns)


class JointSource:
    """The transform of a link that moves with a joint, but for the times in which it was not published."""

    authority = NODE

    def __init__(self, joint: LinkJoint, published: PublishedStates) -> None:
        self.published = published
        self._joint = joint
        self._gaps: list[tuple[int, int | None]] = []

    def drop(self, now_ns: int) -> None:
        """Stop publishing."""
        if not self._gaps or self._gaps[-1][1] is not None:
            self._gaps.append((now_ns, None))

    def resume(self, now_ns: int) -> None:
        """Publish again."""
        if self._gaps and self._gaps[-1][1] is None:
            self._gaps[-1] = (self._gaps[-1][0], now_ns)

    def publishes(self, taken_ns: int) -> bool:
        """Tell whether the transform of a joint state of this simulated instant was published."""
        return not any(begin <= taken_ns and (end is None or taken_ns < end) for begin, end in self._gaps)

    def stamps(self) -> Sequence[int]:
        """Rising stamps of the stored transforms."""
        cache = self.published.cache
        if not self._gaps:
            return cache.stamps
        return [cache.stamps[index] for index in self._kept()]

    def parent(self, index: int) -> str:
        """Return the one parent."""
        return self._joint.parent

    def pose(self, index: int) -> Pose:
        """Return the pose of the link as it was published."""
        values = self.published.cache.values
        used = values[index] if not self._gaps else values[self._kept()[index]]
        return self._joint.pose(dict(zip(self.published.history.names, used.positions, strict=True)))

    def clear(self) -> None:
        """Forget what is stored, for every joint of the broadcaster."""
        self.published.cache.clear()

    def _kept(self) -> list[int]:
        """Return the places of the transforms that were published."""
        return [index for index, used in enumerate(self.published.cache.values) if self.publishes(used.taken_ns)]


class RobotStatePublisher:
    """Publishes every edge of the URDF: fixed ones latched on /tf_static, moving ones from joint states on /tf.

    Attributes:
        links: the edges.
        announced_ns: when the listener began to hear it; None before.
    """

    def __init__(
        self,
        links: LinkTree,
        feeds: Iterable[JointStateFeed],
        rate_hz: float,
        buffer_s: float,
        clocks: Clocks,
        edge: StreamEdge | None = None,
    ) -> None:
        """Bind the node; a joint is taken from the first broadcaster that reports it.

        Args:
            edge: from the node to the listener on /tf; None where the contract does not describe it.
        """
        self.links = links
        self._published = tuple(
            PublishedStates(feed, rate_hz, buffer_s, clocks.of(feed.history.broadcaster), edge) for feed in feeds
        )
        self._moving: dict[str, JointSource] = {}
        self._warnings: TfWarnings | None = None
        self.announced_ns: int | None = None

    @property
    def undelayed(self) -> bool:
        """Tell whether every joint state, and every transform made of it, arrived as it was published."""
        return all(published.undelayed for published in self._published)

    def announce(self, buffer: TransformBuffer, now_ns: int, *, hears_static: bool, hears_moving: bool) -> None:
        """Start publishing to a listener; the names of the joints must be known from a first joint state.

        Args:
            hears_static: the listener is connected on /tf_static.
            hears_moving: the listener is connected on /tf.
        """
        for child, joint in self.links.joints.items():
            source = self._source_of(joint)
            if source is not None and (hears_moving if joint.moves else hears_static):
                buffer.add(child, source)
        self._warnings = buffer.warnings
        self.announced_ns = now_ns
        self.catch_up(now_ns)

    def catch_up(self, now_ns: int) -> None:
        """Publish what the joint states that have arrived by now imply."""
        for published in self._published:
            published.catch_up(now_ns)
            if published.refused_stamps:
                self._warn(published)

    def drop(self, child: str, now_ns: int) -> bool:
        """Stop publishing a moving link; tell whether there is one of this name."""
        source = self._moving.get(child)
        if source is not None:
            source.drop(now_ns)
        return source is not None

    def resume(self, child: str, now_ns: int) -> None:
        """Publish a dropped link again."""
        if child in self._moving:
            self._moving[child].resume(now_ns)

    def publishes(self, child: str, taken_ns: int) -> bool:
        """Tell whether the transform of a moving link was published for a joint state of a simulated instant."""
        return child not in self._moving or self._moving[child].publishes(taken_ns)

    def _warn(self, published: PublishedStates) -> None:
        """Log what the listener refused: one line for each link that moves, as tf2 does."""
        refused, published.refused_stamps = published.refused_stamps, []
        if self._warnings is None:
            return
        for child, source in self._moving.items():
            for stamp_ns in refused if source.published is published else ():
                self._warnings.old_data(child, NODE, stamp_ns)

    def moved_by(self, history: JointStateHistory) -> tuple[LinkJoint, ...]:
        """Return the edges whose transforms come from the joint states of one broadcaster."""
        return tuple(
            joint
            for joint in self.links.joints.values()
            if joint.moves and (published := self._published_of(joint)) and published.history is history
        )

    def _source_of(self, joint: LinkJoint) -> StaticSource | JointSource | None:
        if not joint.moves:
            return StaticSource(joint.parent, NODE, joint.origin)
        published = self._published_of(joint)
        if published is None:
            return None
        self._moving[joint.child] = JointSource(joint, published)
        return self._moving[joint.child]

    def _published_of(self, joint: LinkJoint) -> PublishedStates | None:
        followed = joint.follows or joint.name
        return next((each for each in self._published if followed in each.history.names), None)
