"""Watches of the middleware: deadlines that are missed and leases that run out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


class Timers(Protocol):
    """The simulated clock as the bus needs it."""

    @property
    def now_ns(self) -> int:
        """The simulated time."""
        ...

    def at_background(self, when_ns: int, action: Callable[[], None]) -> None:
        """Call an action at a time."""
        ...


class DeadlineWatch:
    """Counts periods without a sample (DDS 1.4, 2.2.3.7): one miss for each period that has passed.

    The first sample starts it: an instance that was never written has no deadline. A sample at the very end of its
    period is in time. One timer is pending at most, however many samples come.
    """

    def __init__(self, period_s: float, timers: Timers, missed: Callable[[], None]) -> None:
        """Bind the watch; ``missed`` is called once for each period without a sample."""
        self._period_ns = round(period_s * 1e9)
        self._timers = timers
        self._missed = missed
        self._due_ns: int | None = None
        self._seen_ns = 0

    def note(self) -> None:
        """Take note of a sample."""
        self._seen_ns = self._timers.now_ns
        if self._due_ns is None:
            self._arm(self._seen_ns + self._period_ns)

    def _arm(self, due_ns: int) -> None:
        self._due_ns = due_ns
        self._timers.at_background(due_ns + 1, self._look)

    def _look(self) -> None:
        assert self._due_ns is not None  # only an armed watch looks
        if self._seen_ns + self._period_ns > self._due_ns:
            self._arm(self._seen_ns + self._period_ns)
        else:
            self._missed()
            self._arm(self._due_ns + self._period_ns)


class StreamDeadline:
    """The same count for a dense stream, which is looked at when a period is over and not at every sample."""

    def __init__(
        self, period_s: float, timers: Timers, newest_ns: Callable[[int], int | None], missed: Callable[[], None]
    ) -> None:
        """Bind the watch, which begins with the first sample that it finds.

        Args:
            newest_ns: returns the arrival time of the last sample up to a time; None before the first.
            missed: is called once for each period without a sample.
        """
        self._period_ns = round(period_s * 1e9)
        self._timers = timers
        self._newest_ns = newest_ns
        self._missed = missed
        self._due_ns: int | None = None
        timers.at_background(timers.now_ns + self._period_ns, self._look)

    def _look(self) -> None:
        now_ns = self._timers.now_ns
        newest_ns = self._newest_ns(now_ns if self._due_ns is None else self._due_ns)
        if newest_ns is None:
            self._timers.at_background(now_ns + self._period_ns, self._look)
        elif self._due_ns is None or newest_ns + self._period_ns > self._due_ns:
            self._arm(newest_ns + self._period_ns)
        else:
            self._missed()
            self._arm(self._due_ns + self._period_ns)

    def _arm(self, due_ns: int) -> None:
        self._due_ns = due_ns
        self._timers.at_background(due_ns + 1, self._look)


class Lease:
    """Whether a writer counts as alive (DDS 1.4, 2.2.3.11): it must be asserted within each lease duration.

    Attributes:
        alive: it was asserted in time; False before the first assertion.
    """

    def __init__(self, lease_s: float, timers: Timers, changed: Callable[[bool], None]) -> None:
        """Bind the lease; ``changed`` is called with True when the writer comes alive, False when its lease is over."""
        self.alive = False
        self._lease_ns = round(lease_s * 1e9)
        self._timers = timers
        self._changed = changed
        self._seen_ns = 0
        self._armed = False
        self._held = False

    def assert_alive(self) -> None:
        """Assert the writer once: by a sample or a call."""
        self._seen_ns = self._timers.now_ns
        self._held = False
        self._come_alive()
        if not self._armed:
            self._arm()

    def hold(self) -> None:
        """Assert the writer continuously from now on, as the middleware does for automatic liveliness."""
        self._held = True
        self._come_alive()

    def _come_alive(self) -> None:
        if not self.alive:
            self.alive = True
            self._changed(True)

    def _arm(self) -> None:
        self._armed = True
        self._timers.at_background(self._seen_ns + self._lease_ns + 1, self._look)

    def _look(self) -> None:
        self._armed = False
        if self._held or not self.alive:
            return
        if self._timers.now_ns <= self._seen_ns + self._lease_ns:
            self._arm()
        else:
            self.alive = False
            self._changed(False)
