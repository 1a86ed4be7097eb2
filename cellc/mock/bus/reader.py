"""The receiving side of a subscription: what its middleware watches and tells."""

from __future__ import annotations

from typing import Generic

from cellc.mock.bus.edge import Sample
from cellc.mock.bus.events import QosEvent, QosEventKind
from cellc.mock.bus.network import Network
from cellc.mock.bus.subscription import Subscription
from cellc.mock.bus.timers import DeadlineWatch


class Reader(Generic[Sample]):
    """Fills a subscription and watches its requested deadline and the liveliness of its writers."""

    def __init__(self, topic: str, subscription: Subscription[Sample], network: Network) -> None:
        """Bind the reader to its subscription."""
        self.subscription = subscription
        self.endpoint = subscription.endpoint
        self._topic = topic
        self._network = network
        self._alive = 0
        self._not_alive = 0
        deadline_s = self.endpoint.qos.deadline_s if network.middleware.tells else None
        self._deadline = None if deadline_s is None else DeadlineWatch(deadline_s, network.timers, self._missed)

    def deliver(self, sample: Sample, expires_ns: int | None) -> None:
        """Put a sample into the queue."""
        if self._deadline is not None:
            self._deadline.note()
        self.subscription.deliver(sample, self._network.timers.now_ns, expires_ns)

    def lose(self, count: int) -> None:
        """Take note of samples that will not come."""
        self.subscription.lost += count
        self._note(QosEventKind.MESSAGE_LOST, count)

    def note_liveliness(self, *, alive: bool, known: bool) -> None:
        """Take note that a writer came alive or is no longer; ``known`` where it had been alive before."""
        self._alive += 1 if alive else -1
        if known:
            self._not_alive += -1 if alive else 1
        self._note(QosEventKind.LIVELINESS_CHANGED, 1, f"{self._alive} alive, {self._not_alive} not alive")

    def _missed(self) -> None:
        self._note(QosEventKind.REQUESTED_DEADLINE_MISSED, 1)

    def _note(self, kind: QosEventKind, count: int, detail: str = "") -> None:
        now_ns = self._network.timers.now_ns
        self._network.events.note(QosEvent(kind, self._topic, self.endpoint.node, now_ns, count, detail))
