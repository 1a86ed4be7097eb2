"""The age of the newest message that has arrived, over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellc.mock.clocks import Clock
from cellc.mock.evidence.trace.envelope import Envelope, EnvelopeBuilder

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
        self._newest_ns: int | None = None
        self._worst_s: float | None = None

    def arrived(self, at_ns: int, stamp_ns: int) -> None:
        """Take a message that arrived at a simulated instant."""
        self.look(at_ns)
        self._newest_ns = stamp_ns
        self.look(at_ns)

    def look(self, at_ns: int) -> None:
        """Note the age at a simulated instant."""
        if self._newest_ns is None:
            return
        age_s = (self._clock.read(at_ns) - self._newest_ns) / 1e9
        self._worst_s = age_s if self._worst_s is None else max(self._worst_s, age_s)
        self._times.append(at_ns)
        self._values.append(age_s)
        if len(self._times) >= _PIECE:
            self._flush()

    def trace(self) -> AgeTrace:
        """Return what was seen."""
        self._flush()
        return AgeTrace(self._source, self._consumer, self._builder.envelope(), self._worst_s, self._max_age_s)

    def _flush(self) -> None:
        self._builder.add(np.array(self._times, dtype=np.int64), np.array(self._values).reshape(-1, 1))
        self._times.clear()
        self._values.clear()
