"""The network between the nodes of a cell: how each edge behaves, what is cut, and what the middleware tells of it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from random import Random

from cellc.contract.contract import ContractInterface
from cellc.mock.bus.behaviour import IDEAL, SEVERED, EdgeBehaviour, edge_random
from cellc.mock.bus.events import QosEvents
from cellc.mock.bus.middleware import DDS, Middleware
from cellc.mock.bus.timers import Timers


@dataclass(frozen=True, slots=True)
class EdgeName:
    """An edge: a topic from one node to another."""

    topic: str
    source: str
    sink: str


Apply = Callable[[EdgeBehaviour], None]
"""Gives an edge another behaviour from now on."""


class Network:
    """Behaviours of edges by name, drawn from one seed.

    Attributes:
        events: of the middleware, over all topics.
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
        """Bind the network to what the contract says of it; ``seed`` is that of the run."""
        self.middleware = middleware
        self.events = QosEvents()
        self.timers = timers
        self._seed = seed
        self._declared = {name: _declared(interface) for name, interface in interfaces.items()}
        self._edges: dict[EdgeName, list[Apply]] = {}
        self._disturbed: list[tuple[str, str | None, str | None, EdgeBehaviour]] = []
        self._cuts: list[tuple[frozenset[str], frozenset[str] | None]] = []

    def attach(self, edge: EdgeName, apply: Apply) -> None:
        """Let an edge be told of its behaviour, now and whenever it changes."""
        self._edges.setdefault(edge, []).append(apply)
        apply(self.behaviour(edge))

    def random(self, edge: EdgeName) -> Random:
        """Return the random numbers of an edge, from their beginning."""
        return edge_random(self._seed, edge.topic, edge.source, edge.sink)

    def behaviour(self, edge: EdgeName) -> EdgeBehaviour:
        """Return how an edge behaves now: severed where it is cut, else as last disturbed, else as declared."""
        if self.is_cut(edge.source, edge.sink):
            return SEVERED
        for topic, source, sink, behaviour in reversed(self._disturbed):
            if topic == edge.topic and source in (None, edge.source) and sink in (None, edge.sink):
                return behaviour
        return self._declared.get(edge.topic, IDEAL)

    def disturb(
        self, topic: str, behaviour: EdgeBehaviour, *, source: str | None = None, sink: str | None = None
    ) -> None:
        """Change how the edges of a topic behave from now on; all, or those from a source or to a sink."""
        self._disturbed.append((topic, source, sink, behaviour))
        self._tell()

    def calm(self, topic: str) -> None:
        """Let the edges of a topic behave as declared again."""
        self._disturbed = [entry for entry in self._disturbed if entry[0] != topic]
        self._tell()

    def cut(self, nodes: Collection[str], others: Collection[str] | None = None) -> None:
        """Let nothing pass between two groups of nodes, or between a group and everybody else, in either direction."""
        self._cuts.append((frozenset(nodes), None if others is None else frozenset(others)))
        self._tell()

    def mend(self) -> None:
        """Undo every cut."""
        self._cuts.clear()
        self._tell()

    def is_cut(self, node: str, other: str) -> bool:
        """Tell whether nothing passes between two nodes; ask it for services and actions too."""
        for group, others in self._cuts:
            for one, two in ((node, other), (other, node)):
                if one in group and (two not in group if others is None else two in others):
                    return True
        return False

    def _tell(self) -> None:
        for edge, applies in self._edges.items():
            behaviour = self.behaviour(edge)
            for apply in applies:
                apply(behaviour)


def _declared(interface: ContractInterface) -> EdgeBehaviour:
    stated = interface.simulated
    if stated is None:
        return IDEAL
    return EdgeBehaviour(stated.latency_s, stated.jitter_s, stated.loss, stated.reordering)
