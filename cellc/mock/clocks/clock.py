"""One clock: what it reads at a simulated instant, with offset, drift and jumps."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil


@dataclass(frozen=True, slots=True)
class Segment:
    """From the simulated instant ``from_ns`` on the clock reads ``reading_ns`` and runs at ``rate``.

    ``rate`` is 1 for a perfect clock, 1.00002 for one that gains 20 ppm.
    """

    from_ns: int
    reading_ns: int
    rate: float

    def read(self, true_ns: int) -> int:
        """Return the reading at a simulated instant of the segment."""
        elapsed_ns = true_ns - self.from_ns
        return self.reading_ns + (elapsed_ns if self.rate == 1.0 else round(elapsed_ns * self.rate))

    def when(self, reading_ns: int) -> int:
        """Return the first simulated instant at which a clock that has always run like this reads at least so much."""
        ahead_ns = reading_ns - self.reading_ns
        if self.rate == 1.0:
            return self.from_ns + ahead_ns
        true_ns = self.from_ns + ceil(ahead_ns / self.rate)
        while self.read(true_ns - 1) >= reading_ns:
            true_ns -= 1
        while self.read(true_ns) < reading_ns:
            true_ns += 1
        return true_ns


class Clock:
    """A clock that stamps are taken from and ages are measured on.

    Simulated time, which only the mock knows, is the truth; every clock of the cell reads it with its own error.

    Attributes:
        name: host or device that it belongs to, or ``sim`` for /clock.
        domain: clock domain of the spec; clocks of one domain are kept near each other.
        simulated: nodes on it take their time from /clock, as with `use_sim_time`.
    """

    def __init__(self, name: str, domain: str, segments: Sequence[Segment], *, simulated: bool = False) -> None:
        """Bind a clock to its segments in rising order; the first one holds for earlier instants too."""
        self.name = name
        self.domain = domain
        self.simulated = simulated
        self._segments = list(segments)
        self._offset_ns = self._constant_offset_ns()

    def read(self, true_ns: int) -> int:
        """Return what the clock read, or will read as far as is known, at a simulated instant."""
        if self._offset_ns is not None:
            return true_ns + self._offset_ns
        index = bisect_right(self._segments, true_ns, key=lambda segment: segment.from_ns) - 1
        return self._segments[max(0, index)].read(true_ns)

    def when(self, reading_ns: int, since_ns: int) -> int:
        """Return the first simulated instant from ``since_ns`` on at which the clock reads at least ``reading_ns``."""
        ends = [segment.from_ns for segment in self._segments[1:]]
        for segment, end_ns in zip(self._segments, [*ends, None], strict=True):
            true_ns = max(segment.when(reading_ns), since_ns)
            if segment is not self._segments[0]:
                true_ns = max(true_ns, segment.from_ns)
            if end_ns is None or true_ns < end_ns:
                return true_ns
        raise AssertionError("the last segment has no end")

    def jump(self, delta_ns: int, at_ns: int) -> None:
        """Add ``delta_ns`` to every reading from the simulated instant ``at_ns`` on."""
        index = max(0, bisect_right(self._segments, at_ns, key=lambda segment: segment.from_ns) - 1)
        present = self._segments[index]
        later = [
            Segment(segment.from_ns, segment.reading_ns + delta_ns, segment.rate)
            for segment in self._segments[index + 1 :]
        ]
        jumped = Segment(at_ns, present.read(at_ns) + delta_ns, present.rate)
        self._segments[index + 1 :] = [jumped, *later]
        self._offset_ns = None

    def restart(self, reading_ns: int, rate: float, at_ns: int) -> None:
        """Read ``reading_ns`` at the simulated instant ``at_ns`` and run at ``rate`` from there on."""
        before = [segment for segment in self._segments if segment.from_ns < at_ns]
        self._segments = [*(before or self._segments[:1]), Segment(at_ns, reading_ns, rate)]
        self._offset_ns = None

    def _constant_offset_ns(self) -> int | None:
        """Return the offset of a clock that neither drifts nor jumped, which is what most clocks are."""
        first = self._segments[0]
        return first.reading_ns - first.from_ns if len(self._segments) == 1 and first.rate == 1.0 else None


def perfect_clock(name: str, domain: str, *, simulated: bool = False) -> Clock:
    """Return a clock that reads simulated time itself."""
    return Clock(name, domain, (Segment(0, 0, 1.0),), simulated=simulated)
