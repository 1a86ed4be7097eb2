"""The receiving end of a topic: a queue with history and depth."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from cellc.contract.contract import ContractEndpoint

Sample = TypeVar("Sample")


@dataclass(frozen=True, slots=True)
class Received(Generic[Sample]):
    """A sample in the queue of a subscription, with the time at which it arrived."""

    arrived_ns: int
    expires_ns: int | None
    sample: Sample


class Subscription(Generic[Sample]):
    """Holds what has arrived and was not taken yet; a full keep-last queue drops its oldest sample.

    Attributes:
        endpoint: who subscribes, and the profile that it requests.
        arrived: number of samples that arrived.
        dropped: number of samples that the queue had no room for.
        expired: number of samples that outlived their lifespan on their way or in the queue.
        lost: number of samples that never arrived, as far as the subscription knows.
    """

    def __init__(self, endpoint: ContractEndpoint, on_sample: Callable[[], None] | None = None) -> None:
        """Bind the subscription; ``on_sample`` is called after each arrival."""
        self.lost = 0
        self.endpoint = endpoint
        self.arrived = 0
        self.dropped = 0
        self.expired = 0
        keep_all = endpoint.qos.history == "keep_all"
        self._depth = None if keep_all else max(1, endpoint.qos.depth)
        self._queue: deque[Received[Sample]] = deque()
        self._on_sample = on_sample

    def deliver(self, sample: Sample, now_ns: int, expires_ns: int | None) -> None:
        """Put an arriving sample at the end of the queue, unless its lifespan is over."""
        if expires_ns is not None and now_ns >= expires_ns:
            self.expired += 1
            return
        self.arrived += 1
        if self._depth is not None and len(self._queue) >= self._depth:
            self._queue.popleft()
            self.dropped += 1
        self._queue.append(Received(now_ns, expires_ns, sample))
        if self._on_sample is not None:
            self._on_sample()

    def take(self, now_ns: int) -> Received[Sample] | None:
        """Remove and return the oldest sample whose lifespan has not passed; None where there is none."""
        while self._queue:
            received = self._queue.popleft()
            if received.expires_ns is None or now_ns < received.expires_ns:
                return received
            self.expired += 1
        return None
