"""The joint states of a broadcaster as one of its subscribers hears them."""

from __future__ import annotations

import numpy as np

from cellc.mock.bus.stream import IntArray, StreamEdge
from cellc.mock.world.joint_states import JointStateHistory


class JointStateFeed:
    """What has reached a node of the joint states that a broadcaster published."""

    def __init__(self, history: JointStateHistory, edge: StreamEdge | None) -> None:
        """Bind a subscriber; ``edge`` is None where the contract describes no connection, which then is ideal."""
        self.history = history
        self._edge = edge

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
        """Return when the last messages of the history arrive; `NEVER_NS` or later stands for one that is lost."""
        stamps = self.history.stamps
        arrivals = self.history.arrivals(stamps[-count:])
        if self._edge is None or self._edge.ideal:
            return arrivals
        return self._edge.arrivals(stamps)[-count:] + (arrivals - stamps[-count:])

    def arrived(self, now_ns: int) -> IntArray:
        """Return the places in the history of all messages that have arrived, rising."""
        stamps = self.history.stamps
        if self._edge is None or self._edge.ideal:
            if not self.history.late:
                return np.arange(self.history.arrived(now_ns), dtype=np.int64)
            return np.flatnonzero(self.history.arrivals(stamps) <= now_ns)
        delayed = self.history.arrivals(stamps) - stamps
        return np.flatnonzero(self._edge.arrivals(stamps) + delayed <= now_ns)
