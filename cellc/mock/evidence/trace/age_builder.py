"""The age of the newest message that has arrived, over time."""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np

from cellc.mock.clocks import Clock
from cellc.mock.evidence.trace.envelope import FIRST_WIDTH_NS, Envelope, EnvelopeBuilder

_PIECE = 512
"""Ages that are put into the envelope at once."""


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
