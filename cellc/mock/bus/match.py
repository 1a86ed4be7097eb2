"""A publisher and a subscription that match: the edge between them, and the lease that one keeps of the other."""

from __future__ import annotations

from typing import Generic

from cellc.contract.contract import ContractEndpoint
from cellc.mock.bus.behaviour import SEVERED, EdgeBehaviour
from cellc.mock.bus.edge import Edge, Sample
from cellc.mock.bus.network import EdgeName, Network
from cellc.mock.bus.reader import Reader
from cellc.mock.bus.timers import Lease


class Match(Generic[Sample]):
    """Carries what one publisher sends to one reader."""

    def __init__(self, topic: str, source: ContractEndpoint, reader: Reader[Sample], network: Network) -> None:
        """Bind a pair whose profiles are compatible."""
        sink = reader.endpoint
        name = EdgeName(topic, source.node, sink.node)
        self._reader = reader
        self._manual = source.qos.liveliness == "manual_by_topic"
        self._was_alive = False
        lease_s = sink.qos.lease_duration_s if network.middleware.tells else None
        self._lease = None if lease_s is None else Lease(lease_s, network.timers, self._note_liveliness)
        self._edge = Edge[Sample](
            reliable=(source.qos.reliability, sink.qos.reliability) == ("reliable", "reliable"),
            depth=None if source.qos.history == "keep_all" else max(1, source.qos.depth),
            random=network.random(name),
            timers=network.timers,
            deliver=self._deliver,
            lose=reader.lose,
        )
        network.attach(name, self._behave)

    def send(self, sample: Sample, expires_ns: int | None) -> None:
        """Send the next sample of the publisher."""
        self._edge.send(sample, expires_ns)

    def replay(self, sample: Sample, expires_ns: int | None) -> None:
        """Give the reader a sample that was published before it joined."""
        self._deliver(sample, expires_ns)

    def hear_assertion(self) -> None:
        """Let the reader hear that the publisher asserted itself without a sample."""
        if self._lease is not None and self._edge.behaviour != SEVERED:
            self._lease.assert_alive()

    def _behave(self, behaviour: EdgeBehaviour) -> None:
        was_severed = self._edge.behaviour == SEVERED
        self._edge.behaviour = behaviour
        if self._lease is None or self._manual:
            return
        if behaviour != SEVERED:
            self._lease.hold()
        elif not was_severed and self._lease.alive:
            self._lease.assert_alive()  # the last assertion that the middleware could send

    def _deliver(self, sample: Sample, expires_ns: int | None) -> None:
        if self._lease is not None and self._manual:
            self._lease.assert_alive()
        self._reader.deliver(sample, expires_ns)

    def _note_liveliness(self, alive: bool) -> None:
        self._reader.note_liveliness(alive=alive, known=self._was_alive)
        self._was_alive = True
