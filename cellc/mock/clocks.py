"""Clocks of hosts and devices with offset, drift and jumps: stamps are made on one, ages are measured on another."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from math import ceil

from cellc.contract.contract import ContractClock
from cellc.contract.frozen import dataclass

DEFAULT = "ros"
"""Name and domain of the clock of everything whose host the contract does not state."""


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

    @property
    def steady(self) -> bool:
        """Tell whether it neither drifts nor jumped."""
        return self._offset_ns is not None

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


@dataclass(frozen=True, slots=True)
class TimeJump:
    """A clock was set: by ``delta_ns``, or to another source of time where ``source_changed``."""

    clock: Clock
    delta_ns: int
    at_ns: int
    source_changed: bool = False


class Clocks:
    """The clocks of the cell by name, and the clock of each node, device and controller.

    Attributes:
        jumps: every jump so far, in order.
    """

    def __init__(self, clocks: Mapping[str, Clock], clock_of: Mapping[str, str], now_ns: Callable[[], int]) -> None:
        """Bind the clocks.

        Args:
            clocks: by name.
            clock_of: name of the clock of each node, device and controller; others share one that starts perfect.
            now_ns: the simulated time.
        """
        self.jumps: list[TimeJump] = []
        self._clocks = {DEFAULT: perfect_clock(DEFAULT, DEFAULT), **clocks}
        self._default = self._clocks[DEFAULT]
        self._of = {node: self._clocks[name] for node, name in clock_of.items()}
        self._now_ns = now_ns
        self._listeners: list[Callable[[TimeJump], None]] = []

    @property
    def steady(self) -> bool:
        """Tell whether no clock drifts or has jumped."""
        return all(clock.steady for clock in self._clocks.values())

    def of(self, node: str) -> Clock:
        """Return the clock that a node, device or controller stamps with."""
        return self._of.get(node, self._default)

    def now_ns(self, node: str) -> int:
        """Return what a node calls now."""
        return self.of(node).read(self._now_ns())

    def age_ns(self, node: str, stamp_ns: int) -> int:
        """Return the age of a stamp on the clock of the node that consumes it; negative for one from the future."""
        return self.now_ns(node) - stamp_ns

    def stale_at_ns(self, node: str, stamp_ns: int, max_age_ns: int) -> int:
        """Return the first simulated instant, from now on, at which a node finds a stamp older than ``max_age_ns``."""
        return self.of(node).when(stamp_ns + max_age_ns + 1, self._now_ns())

    def names(self) -> tuple[str, ...]:
        """Return the names of all clocks, sorted; each belongs to a host or a device."""
        return tuple(sorted(self._clocks))

    def select(self, name: str) -> tuple[Clock, ...]:
        """Return the clocks that have this name or belong to the domain of this name.

        Raises:
            KeyError: the name is unknown.
        """
        chosen = tuple(clock for clock in self._clocks.values() if name in (clock.name, clock.domain))
        if not chosen:
            raise KeyError(name)
        return chosen

    def listen(self, listener: Callable[[TimeJump], None]) -> None:
        """Call ``listener`` right after every jump."""
        self._listeners.append(listener)

    def jump(self, name: str, delta_ns: int) -> None:
        """Set a clock, or all clocks of a domain, forwards or, with a negative ``delta_ns``, back.

        Raises:
            KeyError: neither a clock nor a domain has this name.
        """
        at_ns = self._now_ns()
        for clock in self.select(name):
            clock.jump(delta_ns, at_ns)
            self._tell(TimeJump(clock, delta_ns, at_ns))

    def replay(self, recorded_ns: int, rate: float = 1.0) -> None:
        """Let every node live in the time of a recording from now on, as `use_sim_time` and a played bag do.

        Args:
            recorded_ns: stamp at which the recording begins.
            rate: seconds of the recording in one second.
        """
        at_ns = self._now_ns()
        for clock in self._clocks.values():
            delta_ns = recorded_ns - clock.read(at_ns)
            source_changed = not clock.simulated
            clock.restart(recorded_ns, rate, at_ns)
            clock.simulated = True
            self._tell(TimeJump(clock, delta_ns, at_ns, source_changed))

    def _tell(self, jump: TimeJump) -> None:
        self.jumps.append(jump)
        for listener in self._listeners:
            listener(jump)


def build_clocks(
    declared: Mapping[str, ContractClock], clock_of: Mapping[str, str], now_ns: Callable[[], int]
) -> Clocks:
    """Return the clocks of a cell as they are when it is switched on.

    Args:
        declared: clocks of the contract by name.
        clock_of: clock of each node, controller and device; one that is not declared counts as not stated.
        now_ns: the simulated time.
    """
    clocks = {name: clock_from(name, entry) for name, entry in declared.items()}
    return Clocks(clocks, {node: clock for node, clock in clock_of.items() if clock in clocks}, now_ns)


def clock_from(name: str, entry: ContractClock) -> Clock:
    """Return a clock that starts at its offset and drifts; one that is disciplined drifts no further than its bound.

    A stated offset beyond the bound stays: that is a discipline that failed before the rehearsal began.
    """
    offset_ns = round(entry.offset_s * 1e9)
    first = Segment(0, offset_ns, 1.0 + entry.drift)
    segments = [first]
    if entry.drift != 0.0 and entry.max_offset_s is not None:
        bound_ns = round(entry.max_offset_s * 1e9)
        room_ns = max(0, bound_ns - offset_ns if entry.drift > 0.0 else bound_ns + offset_ns)
        held_ns = round(room_ns / abs(entry.drift))
        segments.append(Segment(held_ns, first.read(held_ns), 1.0))
    return Clock(name, entry.domain, segments, simulated=entry.simulated)
