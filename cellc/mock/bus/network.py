"""The network between the nodes of a cell: how each edge behaves, what is cut, and what the middleware tells of it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Mapping
from enum import Enum
from random import Random

from cellc.contract.entities import ContractInterface
from cellc.contract.frozen import dataclass
from cellc.mock.bus.qos import DDS, Middleware
from cellc.mock.bus.timers import Timers

HEARTBEAT_RESPONSE_S = 0.005
"""Delay of a reader's answer to a heartbeat; default of Fast DDS (ReaderTimes::heartbeat_response_delay)."""
NACK_RESPONSE_S = 0.005
"""Delay of a writer's answer to a missing sample; default of Fast DDS (WriterTimes::nack_response_delay)."""


@dataclass(frozen=True, slots=True)
class EdgeBehavior:
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
        """Tell whether every sample arrives immediately."""
        return self is IDEAL or self == IDEAL

    @property
    def retry_s(self) -> float:
        """Time from sending to sending again: heartbeat there, its answer back, and both ends' response delays."""
        return 2.0 * (self.latency_s + self.jitter_s) + HEARTBEAT_RESPONSE_S + NACK_RESPONSE_S


IDEAL = EdgeBehavior()
SEVERED = EdgeBehavior(loss=1.0)
"""Nothing arrives: a cable that was pulled."""


def edge_random(seed: int, topic: str, source: str, sink: str) -> Random:
    """Return the random numbers of one edge; they depend on nothing that happens on other edges."""
    name = "\0".join((str(seed), topic, source, sink))
    return Random(int.from_bytes(hashlib.sha256(name.encode()).digest(), "big"))


class QosEventKind(str, Enum):
    """Names of rmw_event_type_t, without the prefix; the values say what happened in words."""

    OFFERED_DEADLINE_MISSED = "offered deadline missed"
    REQUESTED_DEADLINE_MISSED = "requested deadline missed"
    LIVELINESS_LOST = "liveliness lost"
    LIVELINESS_CHANGED = "liveliness changed"
    OFFERED_QOS_INCOMPATIBLE = "offered QoS incompatible"
    REQUESTED_QOS_INCOMPATIBLE = "requested QoS incompatible"
    MESSAGE_LOST = "message lost"


@dataclass(frozen=True, slots=True)
class QosEvent:
    """One event of an endpoint; ``detail`` says what rmw puts in the status beside the count."""

    kind: QosEventKind
    topic: str
    node: str
    at_ns: int
    count: int = 1
    detail: str = ""


class QosEvents:
    """The events of all endpoints so far.

    Attributes:
        log: every event in order.
    """

    def __init__(self) -> None:
        self.log: list[QosEvent] = []
        self._listeners: list[Callable[[QosEvent], None]] = []

    def listen(self, listener: Callable[[QosEvent], None]) -> None:
        """Call ``listener`` with every event from now on."""
        self._listeners.append(listener)

    def note(self, event: QosEvent) -> None:
        """Note an event."""
        self.log.append(event)
        for listener in self._listeners:
            listener(event)

    def total(self, kind: QosEventKind, topic: str, node: str) -> int:
        """Return the total count of an endpoint, as its status says."""
        return sum(event.count for event in self.log if (event.kind, event.topic, event.node) == (kind, topic, node))

    def lines(self) -> tuple[str, ...]:
        """Return one line for each endpoint and kind of event, in the order of their first occurrence.

        Incompatible endpoints are left out: they are found, with the policy, before anything is sent.
        """
        totals: dict[tuple[str, str, QosEventKind], int] = {}
        for event in self.log:
            if event.kind not in (QosEventKind.OFFERED_QOS_INCOMPATIBLE, QosEventKind.REQUESTED_QOS_INCOMPATIBLE):
                key = (event.topic, event.node, event.kind)
                totals[key] = totals.get(key, 0) + event.count
        return tuple(f"`{topic}` at `{node}`: {kind.value}, {count} x" for (topic, node, kind), count in totals.items())


@dataclass(frozen=True, slots=True)
class EdgeName:
    """An edge: a topic from one node to another."""

    topic: str
    source: str
    sink: str


Apply = Callable[[EdgeBehavior], None]
"""Gives an edge another behavior from now on."""


class Network:
    """Behaviors of edges by name, drawn from one seed.

    Attributes:
        events: of the middleware, over all topics.
        disconnections: interfaces that returned with a profile which their peers do not match, one line each.
        middleware: its rules.
        timers: the simulated clock.
    """

    def __init__(
        self,
        interfaces: Mapping[str, ContractInterface],
        timers: Timers,
        seed: int,
        middleware: Middleware = DDS,
    ) -> None:
        """Bind the network to what the contract says about it; ``seed`` is that of the run."""
        self.middleware = middleware
        self.events = QosEvents()
        self.timers = timers
        self.disconnections: list[str] = []
        self._seed = seed
        self._interfaces = interfaces
        self._silent: set[str] = set()
        self._declared = {name: _declared(interface) for name, interface in interfaces.items()}
        self._edges: dict[EdgeName, list[Apply]] = {}
        self._disturbed: list[tuple[str, str | None, str | None, EdgeBehavior]] = []
        self._cuts: list[tuple[frozenset[str], frozenset[str] | None]] = []

    def attach(self, edge: EdgeName, apply: Apply) -> None:
        """Give an edge its behavior, now and at every change."""
        self._edges.setdefault(edge, []).append(apply)
        apply(self.behavior(edge))

    def random(self, edge: EdgeName) -> Random:
        """Return the random numbers of an edge, from their beginning."""
        return edge_random(self._seed, edge.topic, edge.source, edge.sink)

    def behavior(self, edge: EdgeName) -> EdgeBehavior:
        """Return how an edge behaves now: severed where it is cut, else as last disturbed, else as declared."""
        if self.is_cut(edge.source, edge.sink):
            return SEVERED
        for topic, source, sink, behavior in reversed(self._disturbed):
            if topic == edge.topic and source in (None, edge.source) and sink in (None, edge.sink):
                return behavior
        return self._declared.get(edge.topic, IDEAL)

    def disturb(
        self, topic: str, behavior: EdgeBehavior, *, source: str | None = None, sink: str | None = None
    ) -> None:
        """Change how the edges of a topic behave from now on; all, or those from a source or to a sink."""
        self._disturbed.append((topic, source, sink, behavior))
        self._tell()

    def restore_topic(self, topic: str) -> None:
        """Let the edges of a topic behave as declared again."""
        self._disturbed = [entry for entry in self._disturbed if entry[0] != topic]
        self._tell()

    def disconnect(self, topic: str, policy: str) -> None:
        """Let an interface come back with a profile that no peer matches, so that nothing passes any more.

        The middleware of each end logs one line that names the policy; the server of an action or service is not heard.
        """
        interface, now_ns = self._interfaces[topic], self.timers.now_ns
        self.disconnections.append(f"`{topic}` is no longer connected: incompatible QoS, policy {policy}")
        for kind, ends in (
            (QosEventKind.OFFERED_QOS_INCOMPATIBLE, interface.sources),
            (QosEventKind.REQUESTED_QOS_INCOMPATIBLE, interface.sinks),
        ):
            for end in ends:
                self.events.note(QosEvent(kind, topic, end.node, now_ns, detail=policy))
        self.disturb(topic, SEVERED)
        if interface.kind != "topic":
            self.silence(*(source.node for source in interface.sources))

    def reconnect(self, topic: str) -> None:
        """Let an interface come back with its declared profile."""
        self.restore_topic(topic)
        self.restore(*(source.node for source in self._interfaces[topic].sources))

    def silence(self, *servers: str) -> None:
        """Let servers answer nothing from now on."""
        self._silent.update(servers)

    def restore(self, *servers: str) -> None:
        """Let servers answer again what is asked from now on."""
        self._silent.difference_update(servers)

    def answers(self, server: str) -> bool:
        """Tell whether a server answers what it is asked."""
        return server not in self._silent

    def cut(self, nodes: Collection[str], others: Collection[str] | None = None) -> None:
        """Let nothing pass between two groups of nodes, or between a group and everybody else, in either direction."""
        self._cuts.append((frozenset(nodes), None if others is None else frozenset(others)))
        self._tell()

    def undo_cuts(self) -> None:
        """Undo every cut."""
        self._cuts.clear()
        self._tell()

    def is_cut(self, node: str, other: str) -> bool:
        """Tell whether nothing passes between two nodes; ask it for services and actions too."""
        for group, others in self._cuts:
            for first, two in ((node, other), (other, node)):
                if first in group and (two not in group if others is None else two in others):
                    return True
        return False

    def _tell(self) -> None:
        for edge, applies in self._edges.items():
            behavior = self.behavior(edge)
            for apply in applies:
                apply(behavior)


def _declared(interface: ContractInterface) -> EdgeBehavior:
    stated = interface.simulated
    if stated is None:
        return IDEAL
    return EdgeBehavior(stated.latency_s, stated.jitter_s, stated.loss, stated.reordering)
