"""The sending side of a publisher: its history for late joiners, what it promised, and who hears it."""

from __future__ import annotations

from collections import deque
from typing import Generic

from cellc.contract.contract import ContractEndpoint
from cellc.mock.bus.edge import Sample
from cellc.mock.bus.events import QosEvent, QosEventKind
from cellc.mock.bus.match import Match
from cellc.mock.bus.network import Network
from cellc.mock.bus.timers import DeadlineWatch, Lease


class Writer(Generic[Sample]):
    """Sends to every matched reader and watches its own promises.

    Attributes:
        published: number of samples.
    """

    def __init__(self, topic: str, endpoint: ContractEndpoint, network: Network) -> None:
        """Bind the publisher of a topic."""
        self.published = 0
        self._topic = topic
        self._node = endpoint.node
        self._network = network
        self._matches: list[Match[Sample]] = []
        qos = endpoint.qos
        depth = None if qos.history == "keep_all" else max(1, qos.depth)
        self._latched: deque[tuple[Sample, int | None]] | None = None
        if qos.durability == "transient_local":
            self._latched = deque(maxlen=depth)
        self._lifespan_ns = None if qos.lifespan_s is None else round(qos.lifespan_s * 1e9)
        self._deadline: DeadlineWatch | None = None
        if qos.deadline_s is not None and network.middleware.tells:
            self._deadline = DeadlineWatch(qos.deadline_s, network.timers, self._missed)
        # An automatic publisher loses its liveliness with its process alone, and then there is nobody to tell.
        self._lease: Lease | None = None
        if qos.liveliness == "manual_by_topic" and qos.lease_duration_s is not None and network.middleware.tells:
            self._lease = Lease(qos.lease_duration_s, network.timers, self._note_liveliness)

    def publish(self, sample: Sample) -> None:
        """Send a sample."""
        self.published += 1
        expires_ns = None if self._lifespan_ns is None else self._network.timers.now_ns + self._lifespan_ns
        if self._deadline is not None:
            self._deadline.note()
        if self._lease is not None:
            self._lease.assert_alive()
        if self._latched is not None:
            self._latched.append((sample, expires_ns))
        for match in self._matches:
            match.send(sample, expires_ns)

    def assert_liveliness(self) -> None:
        """Say that the publisher is alive, without a sample; means something where liveliness is manual."""
        if self._lease is not None:
            self._lease.assert_alive()
        for match in self._matches:
            match.hear_assertion()

    def connect(self, match: Match[Sample], *, wants_history: bool) -> None:
        """Send to a reader from now on, and first what is latched for it."""
        self._matches.append(match)
        if self._latched is None or not wants_history:
            return
        for sample, expires_ns in self._latched:
            if expires_ns is None or self._network.timers.now_ns < expires_ns:
                match.replay(sample, expires_ns)

    def _missed(self) -> None:
        self._note(QosEventKind.OFFERED_DEADLINE_MISSED)

    def _note_liveliness(self, alive: bool) -> None:
        if not alive:
            self._note(QosEventKind.LIVELINESS_LOST)

    def _note(self, kind: QosEventKind) -> None:
        self._network.events.note(QosEvent(kind, self._topic, self._node, self._network.timers.now_ns))
