"""The stored transforms of one edge, in the order of their stamps: what tf2 calls a time cache."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from cellc.mock.tf.failure import Outside, into_the_future, into_the_past, no_data, one_sample

LATEST = 0
"""A lookup at stamp 0 asks for the latest transform (tf2::TimePointZero)."""

Value = TypeVar("Value")


class TimeCache(Generic[Value]):
    """Values by stamp, over a bounded time before the newest one.

    A stamp that is there already is no mistake to ROS 2: the value that came last is found. TF_REPEATED_DATA was a
    warning of ROS 1.
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
class Neighbours:
    """The stored transforms around a stamp, as indices; ``after`` is None where one answers alone."""

    before: int
    after: int | None
    fraction: float = 0.0


def find(stamps: Sequence[int], stamp_ns: int) -> Neighbours | Outside:
    """Return which of the rising stamps answer for one stamp, or why none does."""
    if not stamps:
        return no_data()
    if stamp_ns == LATEST or stamp_ns == stamps[-1]:
        return Neighbours(len(stamps) - 1, None)
    if len(stamps) == 1:
        return one_sample(stamp_ns, stamps[0])
    if stamp_ns == stamps[0]:
        return Neighbours(0, None)
    if stamp_ns > stamps[-1]:
        return into_the_future(stamp_ns, stamps[-1])
    if stamp_ns < stamps[0]:
        return into_the_past(stamp_ns, stamps[0])
    after = bisect_right(stamps, stamp_ns)
    before_ns = stamps[after - 1]
    if before_ns == stamp_ns:
        return Neighbours(after - 1, None)
    return Neighbours(after - 1, after, (stamp_ns - before_ns) / (stamps[after] - before_ns))
