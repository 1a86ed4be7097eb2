"""The topics of a running cell on a ROS graph: what a bag of the run would hold is published as it happens."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.entities import Qos
from cellc.mock.clocks import Clock
from cellc.mock.engine.simulation import Simulation
from cellc.mock.errors import MockError
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.topics import CLOCK_TOPIC
from cellc.mock.ros.bridge import Bridge
from cellc.mock.ros.parameters import Parameters

MOCK = "/cellc_mock"
"""The node that publishes what no node of the contract does, such as `/clock`."""
_OF_BAGS = "/cellc/"
"""Topics below it exist in bags alone: a real cell does not have them."""
_LEFT_OUT = -1
_SOON_NS = 2_000_000
"""A message of the present cycle is published immediately: it was not delayed."""


def full_names(contract: Contract) -> frozenset[str]:
    """Return the full names of all nodes at an end of an interface, controllers and managers among them."""
    return frozenset(
        end.full_name for interface in contract.interfaces.values() for end in (*interface.sources, *interface.sinks)
    )


class Graph:
    """Publishes what the played nodes do; what nodes under test publish is left to them."""

    def __init__(
        self,
        bridge: Bridge,
        contract: Contract,
        tested: Collection[str],
        clock: Clock,
        simulation: Simulation,
        parameters: Mapping[str, Parameters],
    ) -> None:
        """Bind the graph.

        Args:
            tested: full names of the nodes that are not played.
            clock: that they read, with its error; `/clock` has it.
            parameters: of the nodes that are played, by full name.
        """
        self._simulation = simulation
        self._time = clock
        self._bridge = bridge
        self._contract = contract
        self._tested = frozenset(tested)
        self._channels: dict[str, int] = {}
        self._latched: set[int] = set()
        self._heard: frozenset[int] = frozenset()
        for node in sorted((full_names(contract) | set(parameters)) - self._tested):
            bridge.open_node(node, parameters.get(node, {}))
        self._clock = self.declare(CLOCK_TOPIC.name, CLOCK_TOPIC.kind, CLOCK_TOPIC.qos)

    def declare(self, topic: str, kind: str, qos: Qos) -> int:
        """Return the channel of a topic, opened where it is new and a played node publishes it."""
        source = self._source(topic)
        if topic.startswith(_OF_BAGS) or source is None:
            return _LEFT_OUT
        if topic not in self._channels:
            self._channels[topic] = len(self._channels)
            self._bridge.open_publisher(self._channels[topic], source, topic, kind, qos)
            if qos.durability == "transient_local":
                self._latched.add(self._channels[topic])
        return self._channels[topic]

    def write(self, channel: int, data: bytes, publish_ns: int, log_ns: int | None = None) -> None:
        """Publish a serialized message, where somebody hears it or may hear it later.

        Args:
            log_ns: when it arrives, where it was delayed on its way.
        """
        if channel == self._clock:
            self.tick(publish_ns)
        elif channel in self._heard or channel in self._latched:
            if log_ns is not None and log_ns > self._simulation.now_ns + _SOON_NS:
                self._simulation.at_background(log_ns, partial(self._bridge.publish, channel, data))
            else:
                self._bridge.publish(channel, data)

    def subscribe(self, topic: str, kind: str, qos: Qos) -> int:
        """Return the channel of what arrives on a topic."""
        channel = self._channels[f"{topic} in"] = len(self._channels)
        self._bridge.open_subscription(channel, MOCK, topic, kind, qos)
        return channel

    def act(self, node: str, action: str, kind: str) -> int:
        """Return the channel of goals that arrive for an action, which a node offers from now on."""
        channel = self._channels[action] = len(self._channels)
        self._bridge.open_action(channel, node, action, kind)
        return channel

    def serve(self, node: str, service: str, kind: str) -> int:
        """Return the channel of requests that arrive for a service, which a node offers from now on."""
        channel = self._channels[service] = len(self._channels)
        self._bridge.open_service(channel, node, service, kind)
        return channel

    def look(self) -> None:
        """Look again who hears what: what no node hears is neither drawn nor sent."""
        self._heard = self._bridge.heard()

    def is_heard(self, topic: str) -> bool:
        """Tell whether somebody subscribed to a topic when it was looked at last."""
        return self._channels.get(topic, _LEFT_OUT) in self._heard

    def tick(self, now_ns: int) -> None:
        """Publish what the clock of the nodes under test reads at an instant of the run."""
        self._bridge.publish(self._clock, messages.clock(max(0, self._time.read(now_ns))))

    def _source(self, topic: str) -> str | None:
        return _source(self._contract, topic, self._tested)


def refuse_others(bridge: Bridge, contract: Contract, tested: Collection[str]) -> None:
    """Refuse a graph on which somebody is that is played here: the mock publishes nothing beside them.

    Args:
        tested: full names of the nodes that are not played.

    Raises:
        MockError: there is such a node, another mock, or a publisher of a topic that is published here.
    """
    if MOCK in bridge.nodes():
        text = (
            "another cell is played on this domain; end `cellc mock --ros` there, or name another domain with --domain"
        )
        raise MockError("", text)
    otherwise = "it may be that of a real robot; end it, or name another domain with --domain"
    names = full_names(contract) - frozenset(tested)
    for node in sorted(bridge.nodes()):
        if node in names:
            raise MockError("", f"`{node}` is on the graph already, and it is played here: {otherwise}")
    played = [
        name for name, each in contract.interfaces.items() if each.kind == "topic" and _source(contract, name, tested)
    ]
    for name in (CLOCK_TOPIC.name, *played):
        for end in bridge.publishers(name):
            if end.node not in tested:
                raise MockError("", f"`{end.node}` publishes `{name}`, which is played here: {otherwise}")


def _source(contract: Contract, topic: str, tested: Collection[str]) -> str | None:
    """Return the played node that publishes a topic; None where nodes under test alone do."""
    interface = contract.interfaces.get(topic)
    sources = () if interface is None else interface.sources
    played = [source.full_name for source in sources if source.full_name not in tested]
    return played[0] if played else (None if sources else MOCK)
