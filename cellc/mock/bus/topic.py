"""One topic: who is matched with whom, and what passes between them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic

from cellc.contract.contract import ContractEndpoint, ContractInterface
from cellc.mock.bus.edge import Sample
from cellc.mock.bus.events import QosEvent, QosEventKind
from cellc.mock.bus.match import Match
from cellc.mock.bus.network import Network
from cellc.mock.bus.reader import Reader
from cellc.mock.bus.subscription import Subscription
from cellc.mock.bus.writer import Writer


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
        found = self._network.middleware.compare(source.qos, sink.qos)
        if not found:
            match = Match[Sample](self.name, source, reader, self._network)
            self._writers[source.node].connect(match, wants_history=sink.qos.durability == "transient_local")
            return
        self.mismatches += [
            f"`{self.name}` from `{source.node}` to `{sink.node}` is not connected: {problem}" for problem in found
        ]
        now_ns, policies = self._network.timers.now_ns, ", ".join(problem.policy for problem in found)
        for kind, node in (
            (QosEventKind.OFFERED_QOS_INCOMPATIBLE, source.node),
            (QosEventKind.REQUESTED_QOS_INCOMPATIBLE, sink.node),
        ):
            self._network.events.note(QosEvent(kind, self.name, node, now_ns, detail=policies))
