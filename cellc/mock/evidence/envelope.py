"""Signals and ages of messages over any length of time in bounded memory, without losing an extreme value."""

from __future__ import annotations

from heapq import heappop, heappush

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.mock.clocks import Clock

Array = NDArray[np.float64]
Times = NDArray[np.int64]

_SLOTS = 1024
FIRST_WIDTH_NS = 10_000_000
"""Length of a slot at first; what changes more slowly should be added as often."""

_PIECE = 512
"""Ages that are put into the envelope immediately."""


@dataclass(frozen=True, slots=True)
class Envelope:
    """Least and greatest value of some signals in each slot of time.

    Attributes:
        width_ns: length of a slot.
        starts_ns: begin of each slot that has a value, shape (n,).
        lowest: least values, shape (n, signals); NaN where a signal had none.
        highest: greatest values, the same way.
    """

    width_ns: int
    starts_ns: Times
    lowest: Array
    highest: Array

    @property
    def extremes(self) -> tuple[float, float]:
        """The least and the greatest value; zeros without one."""
        if not np.isfinite(self.lowest).any():
            return 0.0, 0.0
        return float(np.nanmin(self.lowest)), float(np.nanmax(self.highest))


class EnvelopeBuilder:
    """Adds samples to slots; when they do not fit any more, each two neighboring slots become one."""

    def __init__(self, signals: int) -> None:
        self._width_ns = FIRST_WIDTH_NS
        self._lowest: Array = np.full((_SLOTS, signals), np.nan)
        self._highest: Array = np.full((_SLOTS, signals), np.nan)

    def add(self, times_ns: Times, values: Array) -> None:
        """Add samples at times from 0 on, shape (samples, signals)."""
        if not len(times_ns):
            return
        while int(times_ns.max()) // self._width_ns >= _SLOTS:
            self._widen()
        slots = times_ns // self._width_ns
        np.fmin.at(self._lowest, slots, values)
        np.fmax.at(self._highest, slots, values)

    def envelope(self) -> Envelope:
        """Return the slots that have a value."""
        used = np.flatnonzero(~np.isnan(self._lowest).all(axis=1))
        starts: Times = used.astype(np.int64) * self._width_ns
        return Envelope(self._width_ns, starts, self._lowest[used], self._highest[used])

    def _widen(self) -> None:
        self._width_ns *= 2
        empty = np.full((_SLOTS // 2, self._lowest.shape[1]), np.nan)
        self._lowest = np.concatenate([np.fmin(self._lowest[0::2], self._lowest[1::2]), empty])
        self._highest = np.concatenate([np.fmax(self._highest[0::2], self._highest[1::2]), empty])


@dataclass(frozen=True, slots=True)
class AgeTrace:
    """How old a stream was for who consumes it.

    Attributes:
        source: what was consumed, in words.
        consumer: node on whose clock ages are measured.
        envelope: one signal, s.
        worst_s: greatest age; None where nothing arrived.
        max_age_s: oldest that may be used; None where nothing bounds it.
    """

    source: str
    consumer: str
    envelope: Envelope
    worst_s: float | None
    max_age_s: float | None


class AgeBuilder:
    """Follows one stream: the age falls with each message that arrives, and rises until the next."""

    def __init__(self, source: str, consumer: str, clock: Clock, max_age_s: float | None) -> None:
        """Bind the stream to the clock of its consumer."""
        self._source = source
        self._consumer = consumer
        self._clock = clock
        self._max_age_s = max_age_s
        self._builder = EnvelopeBuilder(1)
        self._times: list[int] = []
        self._values: list[float] = []
        self._travelling: list[tuple[int, int, int]] = []
        self._sent = 0
        self._newest: tuple[int, int] | None = None
        self._looked_ns = 0
        self._worst_s: float | None = None

    def sent(self, arrives_ns: int, stamp_ns: int) -> None:
        """Take a message that will arrive at a simulated instant; later ones may overtake it."""
        heappush(self._travelling, (arrives_ns, self._sent, stamp_ns))
        self._sent += 1

    def advance(self, now_ns: int) -> None:
        """Let arrive what has arrived by a simulated instant."""
        while self._travelling and self._travelling[0][0] <= now_ns:
            arrives_ns, number, stamp_ns = heappop(self._travelling)
            self._rise(arrives_ns)
            if self._newest is None or number > self._newest[0]:
                self._newest = (number, stamp_ns)
            self._note(arrives_ns)
        self._rise(now_ns)

    def trace(self) -> AgeTrace:
        """Return what was seen."""
        self._flush()
        return AgeTrace(self._source, self._consumer, self._builder.envelope(), self._worst_s, self._max_age_s)

    def _rise(self, until_ns: int) -> None:
        """Note how the age rises, in each slot of the envelope."""
        for at_ns in range(self._looked_ns + FIRST_WIDTH_NS, until_ns, FIRST_WIDTH_NS):
            self._note(at_ns)
        self._note(until_ns)

    def _note(self, at_ns: int) -> None:
        self._looked_ns = max(self._looked_ns, at_ns)
        if self._newest is None:
            return
        age_s = (self._clock.read(at_ns) - self._newest[1]) / 1e9
        self._worst_s = age_s if self._worst_s is None else max(self._worst_s, age_s)
        self._times.append(at_ns)
        self._values.append(age_s)
        if len(self._times) >= _PIECE:
            self._flush()

    def _flush(self) -> None:
        self._builder.add(np.array(self._times, dtype=np.int64), np.array(self._values).reshape(-1, 1))
        self._times.clear()
        self._values.clear()
