"""Publishers and subscriptions of one topic by name, connected where their profiles match."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic

from cellc.contract.entities import ContractEndpoint, ContractInterface
from cellc.mock.bus.edge import Edge, Reader, Sample, Subscription
from cellc.mock.bus.network import SEVERED, EdgeBehavior, EdgeName, Network, QosEvent, QosEventKind
from cellc.mock.bus.timers import DeadlineWatch, Lease


class Match(Generic[Sample]):
    """Carries what one publisher sends to one reader."""

    def __init__(self, topic: str, source: ContractEndpoint, reader: Reader[Sample], network: Network) -> None:
        """Bind a pair whose profiles are compatible."""
        sink = reader.endpoint
        name = EdgeName(topic, source.node, sink.node)
        self._reader = reader
        self._manual = source.qos.liveliness == "manual_by_topic"
        self._was_alive = False
        lease_s = sink.qos.lease_duration_s if network.middleware.reports_events else None
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
        if self._lease is not None and self._edge.behavior != SEVERED:
            self._lease.assert_alive()

    def _behave(self, behavior: EdgeBehavior) -> None:
        was_severed = self._edge.behavior == SEVERED
        self._edge.behavior = behavior
        if self._lease is None or self._manual:
            return
        if behavior != SEVERED:
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
        if qos.deadline_s is not None and network.middleware.reports_events:
            self._deadline = DeadlineWatch(qos.deadline_s, network.timers, self._missed)
        # An automatic publisher loses its liveliness with its process alone, and then no reader is left.
        self._lease: Lease | None = None
        if (
            qos.liveliness == "manual_by_topic"
            and qos.lease_duration_s is not None
            and network.middleware.reports_events
        ):
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


class Topic(Generic[Sample]):
    """Publishers and subscriptions of one name; only compatible pairs are connected."""

    def __init__(self, name: str, interface: ContractInterface, network: Network) -> None:
        """Bind a topic of the contract to the network that carries it."""
        self.name = name
        self.mismatches: list[str] = []
        self._interface = interface
        self._network = network
        self._writers = {source.node: Writer[Sample](name, source, network) for source in interface.sources}

    @property
    def published(self) -> int:
        """Number of samples that were published, all sources together."""
        return sum(writer.published for writer in self._writers.values())

    def subscribe(self, node: str, on_sample: Callable[[], None] | None = None) -> Subscription[Sample] | None:
        """Create the declared subscription of a node; a late joiner receives what is latched for it.

        Returns:
            The subscription, or None where the contract does not declare the node as a sink.
        """
        endpoint = next((sink for sink in self._interface.sinks if sink.node == node), None)
        if endpoint is None:
            return None
        subscription = Subscription[Sample](endpoint, on_sample)
        reader = Reader[Sample](self.name, subscription, self._network)
        for source in self._interface.sources:
            self._match(source, reader)
        return subscription

    def publish(self, node: str, sample: Sample) -> None:
        """Send a sample of a declared source to every subscription that it is compatible with."""
        writer = self._writers.get(node)
        if writer is not None:
            writer.publish(sample)

    def assert_liveliness(self, node: str) -> None:
        """Let a source with manual liveliness say that it is alive, without a sample."""
        writer = self._writers.get(node)
        if writer is not None:
            writer.assert_liveliness()

    def _match(self, source: ContractEndpoint, reader: Reader[Sample]) -> None:
        sink = reader.endpoint
        mismatches = self._network.middleware.compare(source.qos, sink.qos)
        if not mismatches:
            match = Match[Sample](self.name, source, reader, self._network)
            self._writers[source.node].connect(match, wants_history=sink.qos.durability == "transient_local")
            return
        self.mismatches += [
            f"`{self.name}` from `{source.node}` to `{sink.node}` is not connected: {problem}" for problem in mismatches
        ]
        now_ns, policies = self._network.timers.now_ns, ", ".join(problem.policy for problem in mismatches)
        for kind, node in (
            (QosEventKind.OFFERED_QOS_INCOMPATIBLE, source.node),
            (QosEventKind.REQUESTED_QOS_INCOMPATIBLE, sink.node),
        ):
            self._network.events.note(QosEvent(kind, self.name, node, now_ns, detail=policies))
