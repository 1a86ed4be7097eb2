"""What a network does to the samples of one edge: a publisher, a topic and one of its subscriptions."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from random import Random

HEARTBEAT_RESPONSE_S = 0.005
"""Delay of a reader's answer to a heartbeat; default of Fast DDS (ReaderTimes::heartbeat_response_delay)."""
NACK_RESPONSE_S = 0.005
"""Delay of a writer's answer to a missing sample; default of Fast DDS (WriterTimes::nack_response_delay)."""


@dataclass(frozen=True, slots=True)
class EdgeBehaviour:
    """How samples travel; each is drawn on its own from the seed of the edge.

    Attributes:
        latency_s: shortest time from publishing to arrival.
        jitter_s: up to so much more, evenly spread.
        loss: share of samples that do not arrive when they are first sent, 0 to 1.
        reordering: share of samples that are overtaken by the next one, 0 to 1.
    """

    latency_s: float = 0.0
    jitter_s: float = 0.0
    loss: float = 0.0
    reordering: float = 0.0

    @property
    def is_ideal(self) -> bool:
        """Tell whether every sample arrives at once."""
        return self == IDEAL

    @property
    def retry_s(self) -> float:
        """Time from sending to sending again: heartbeat there, its answer back, and both ends' response delays."""
        return 2.0 * (self.latency_s + self.jitter_s) + HEARTBEAT_RESPONSE_S + NACK_RESPONSE_S


IDEAL = EdgeBehaviour()
SEVERED = EdgeBehaviour(loss=1.0)
"""Nothing arrives: a cable that was pulled."""


def edge_random(seed: int, topic: str, source: str, sink: str) -> Random:
    """Return the random numbers of one edge; they depend on nothing that happens on other edges."""
    name = "\0".join((str(seed), topic, source, sink))
    return Random(int.from_bytes(hashlib.sha256(name.encode()).digest(), "big"))
