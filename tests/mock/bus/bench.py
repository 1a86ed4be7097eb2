"""One topic between nodes `talker` and `listener` on a clock that the test moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from cellc.contract.entities import ContractEndpoint, ContractInterface, Qos, SimulatedNetwork
from cellc.contract.qos import DEFAULT
from cellc.contract.vocabulary import InterfaceKind
from cellc.mock.bus.edge import Subscription
from cellc.mock.bus.network import Network, QosEventKind
from cellc.mock.bus.qos import DDS, Middleware
from cellc.mock.bus.topic import Topic
from cellc.mock.engine.process import EventQueue

MS = 1_000_000
TOPIC = "/numbers"


def qos(**changes: Any) -> Qos:
    """Return the default profile with changes."""
    return replace(DEFAULT, **changes)


def endpoint(node: str, profile: Qos) -> ContractEndpoint:
    """Return one end of a topic, with what a topic reads of it."""
    return ContractEndpoint(node=node, full_name=f"/{node}", qos=profile)


class StepClock:
    """Simulated time that moves when the test says so; what was scheduled happens on the way."""

    def __init__(self) -> None:
        self.now_ns = 0
        self._queue = EventQueue()

    def at_background(self, when_ns: int, action: Callable[[], None]) -> None:
        """Schedule an action."""
        self._queue.at(when_ns, action)

    def run_until(self, until_ms: float) -> None:
        """Let everything happen up to a time, that time included."""
        until_ns = round(until_ms * MS)
        while (event := self._queue.pop_due(until_ns)) is not None:
            self.now_ns = max(self.now_ns, event.at_ns)
            event.run()
        self.now_ns = until_ns


class Bench:
    """The topic with everything that a test looks at.

    Attributes:
        received: simulated millisecond of arrival and sample, in order; for a listener that takes at once.
    """

    def __init__(
        self,
        offered: Qos,
        requested: Qos,
        *,
        network: SimulatedNetwork | None = None,
        seed: int = 0,
        talkers: tuple[str, ...] = ("talker",),
        middleware: Middleware = DDS,
    ) -> None:
        interface = ContractInterface(
            kind=InterfaceKind.TOPIC,
            type="std_msgs/msg/Int32",
            sources=tuple(endpoint(talker, offered) for talker in talkers),
            sinks=(endpoint("listener", requested),),
            simulated=network,
        )
        self.clock = StepClock()
        self.network = Network({TOPIC: interface}, self.clock, seed, middleware)
        self.topic = Topic[int](TOPIC, interface, self.network)
        self.received: list[tuple[float, int]] = []

    def subscribe(self) -> Subscription[int]:
        """Let the listener join, and queue what arrives."""
        subscription = self.topic.subscribe("listener")
        assert subscription is not None
        return subscription

    def listen(self) -> Subscription[int]:
        """Let the listener join, and take what arrives at once."""

        def take() -> None:
            received = None if subscription is None else subscription.take(self.clock.now_ns)
            assert received is not None
            self.received.append((self.clock.now_ns / MS, received.sample))

        subscription = self.topic.subscribe("listener", take)
        assert subscription is not None
        return subscription

    def publish_every(self, period_ms: float, count: int, first: int = 1) -> None:
        """Publish consecutive numbers from now on, one each period."""
        begun_ms = self.clock.now_ns / MS
        for index in range(count):
            self.clock.run_until(begun_ms + index * period_ms)
            self.topic.publish("talker", first + index)

    def drain(self, subscription: Subscription[int]) -> list[int]:
        """Take everything that is queued."""
        taken = []
        while (received := subscription.take(self.clock.now_ns)) is not None:
            taken.append(received.sample)
        return taken

    def events(self, node: str) -> list[tuple[float, QosEventKind]]:
        """Return the events of a node with their milliseconds, one entry for each count."""
        return [
            (event.at_ns / MS, event.kind)
            for event in self.network.events.log
            if event.node == node
            for _ in range(event.count)
        ]
