"""One topic: who is matched with whom, and what passes between them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic

from cellc.contract.contract import ContractEndpoint, ContractInterface
from cellc.mock.bus.qos import incompatibilities
from cellc.mock.bus.subscription import Sample, Subscription


class Topic(Generic[Sample]):
    """Publishers and subscriptions of one name; only compatible pairs are connected."""

    def __init__(self, name: str, interface: ContractInterface) -> None:
        """Bind a topic of the contract."""
        self.name = name
        self.published = 0
        self.mismatches: list[str] = []
        self._interface = interface
        self._subscriptions: list[Subscription[Sample]] = []
        self._latched: dict[str, deque[tuple[Sample, int | None]]] = {}

    def subscribe(
        self, node: str, now_ns: int, on_sample: Callable[[], None] | None = None
    ) -> Subscription[Sample] | None:
        """Create the declared subscription of a node; a late joiner receives what is latched for it.

        Returns:
            The subscription, or None where the contract does not declare the node as a sink.
        """
        endpoint = next((sink for sink in self._interface.sinks if sink.node == node), None)
        if endpoint is None:
            return None
        subscription = Subscription[Sample](endpoint, on_sample)
        self._subscriptions.append(subscription)
        for source in self._interface.sources:
            self._match(source, subscription, now_ns)
        return subscription

    def publish(self, node: str, sample: Sample, now_ns: int) -> None:
        """Deliver a sample of a declared source to every subscription that it is compatible with."""
        source = next((source for source in self._interface.sources if source.node == node), None)
        if source is None:
            return
        self.published += 1
        lifespan = source.qos.lifespan_s
        expires_ns = None if lifespan is None else now_ns + round(lifespan * 1e9)
        if source.qos.durability == "transient_local":
            depth = None if source.qos.history == "keep_all" else max(1, source.qos.depth)
            self._latched.setdefault(node, deque(maxlen=depth)).append((sample, expires_ns))
        for subscription in self._subscriptions:
            if not incompatibilities(source.qos, subscription.endpoint.qos):
                subscription.deliver(sample, now_ns, expires_ns)

    def _match(self, source: ContractEndpoint, subscription: Subscription[Sample], now_ns: int) -> None:
        found = incompatibilities(source.qos, subscription.endpoint.qos)
        self.mismatches += [
            f"`{self.name}` from `{source.node}` to `{subscription.endpoint.node}` is not connected: {problem}"
            for problem in found
        ]
        if found or subscription.endpoint.qos.durability != "transient_local":
            return
        for sample, expires_ns in self._latched.get(source.node, ()):
            if expires_ns is None or now_ns < expires_ns:
                subscription.deliver(sample, now_ns, expires_ns)
