"""The data flow: who tells what to whom, from sensors down to the controllers, and how old it is when it arrives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from heapq import heapify, heappop, heappush
from itertools import product
from typing import TYPE_CHECKING

from cellc.compiler.catalog.load import load_message_types, load_programs
from cellc.compiler.catalog.tables import InterfaceTypeFacts
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Endpoint, Interface, Node, NodeSource
from cellc.compiler.graph.executors import response, stating
from cellc.contract.diagnostics import YamlPath
from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.qos import Incompatibility, incompatibilities
from cellc.contract.vocabulary import InterfaceKind

if TYPE_CHECKING:
    import networkx


@dataclass(frozen=True, slots=True)
class TopicPair:
    """A publisher of a topic and one of its subscribers, with the policies by which the middleware keeps them apart."""

    topic: Interface
    source: Endpoint
    sink: Endpoint
    rows: tuple[Incompatibility, ...]


# Without slots, so that the graph over all nodes is built once and kept.
@dataclass(frozen=True)
class DataFlow:
    """Interfaces by name, and the edges along which their data goes from node to node.

    Args:
        interfaces: every declaration of a name, in the order of the cell.
        commanders: controllers with command interfaces by the name that ends have, where motion ends.
        frame_edges: edges from the publisher of a dynamic frame to the nodes that plan in it.
    """

    interfaces: Mapping[str, tuple[Interface, ...]]
    commanders: Mapping[str, tuple[Controller, ...]]
    frame_edges: tuple[tuple[str, str], ...]

    def publishers(self, name: str) -> tuple[str, ...]:
        """Name the nodes that publish a topic, or serve a service or action."""
        return tuple(end.node for interface in self.interfaces.get(name, ()) for end in interface.sources)

    def subscribers(self, name: str) -> tuple[str, ...]:
        """Name the nodes that subscribe to a topic, or are clients of a service or action."""
        return tuple(end.node for interface in self.interfaces.get(name, ()) for end in interface.sinks)

    def feeding_motion(self) -> frozenset[str]:
        """Name the topics of which a subscriber can, directly or through others, move a joint."""
        movers = self._movers()
        return frozenset(
            name
            for name, interfaces in self.interfaces.items()
            for interface in interfaces
            if interface.kind is InterfaceKind.TOPIC and any(end.node in movers for end in interface.sinks)
        )

    def way_to_motion(self, interface: Interface) -> str:
        """Write the shortest way from a topic to a controller, such as "`/pose` → `task` → `arm_trajectory`"."""
        paths = [path for sink in interface.sinks if (path := self.path_to_motion(sink.node))]
        shortest = min(paths, key=lambda path: (len(path), path), default=())
        return " → ".join(f"`{name}`" for name in (interface.name, *shortest))

    def unmatched(self) -> Iterator[TopicPair]:
        """Yield each publisher of a topic with each of its subscribers that requests more than it offers."""
        for interfaces in self.interfaces.values():
            offered: dict[Qos, list[tuple[Interface, Endpoint]]] = {}
            requested: dict[Qos, list[Endpoint]] = {}
            for topic in (interface for interface in interfaces if interface.kind is InterfaceKind.TOPIC):
                for source in topic.sources:
                    offered.setdefault(source.qos, []).append((topic, source))
                for sink in topic.sinks:
                    requested.setdefault(sink.qos, []).append(sink)
            for ours, theirs in product(offered, requested):
                if rows := incompatibilities(ours, theirs):
                    ends = product(offered[ours], requested[theirs])
                    yield from (TopicPair(topic, source, sink, rows) for (topic, source), sink in ends)

    def path_to_motion(self, node: str) -> tuple[str, ...]:
        """Return the shortest way from a node to a controller, both included; empty without one."""
        import networkx

        graph = self._digraph
        if node not in graph:
            return ()
        reached = networkx.single_source_shortest_path(graph, node)
        paths = [tuple(path) for name, path in reached.items() if name in self.commanders]
        return min(paths, key=lambda path: (len(path), path), default=())

    def _movers(self) -> frozenset[str]:
        import networkx

        graph = self._digraph
        movers: set[str] = set(self.commanders)
        for name in self.commanders:
            movers |= networkx.ancestors(graph, name)
        return frozenset(movers)

    @cached_property
    def _digraph(self) -> networkx.DiGraph[str]:
        import networkx

        graph: networkx.DiGraph[str] = networkx.DiGraph()
        graph.add_nodes_from(self.commanders)
        for interfaces in self.interfaces.values():
            for interface in interfaces:
                graph.add_edges_from(_edges(interface))
        for name, controllers in self.commanders.items():
            graph.add_edges_from((controller.client, name) for controller in controllers if controller.client)
        graph.add_edges_from(self.frame_edges)
        return graph


def _edges(interface: Interface) -> list[tuple[str, str]]:
    # A request goes from client to server, the other way than the samples of a topic.
    pairs = [(source.node, sink.node) for source in interface.sources for sink in interface.sinks]
    return pairs if interface.kind is InterfaceKind.TOPIC else [(sink, source) for source, sink in pairs]


def build_data_flow(cell: Cell) -> DataFlow:
    """Gather interfaces by name, the controllers that move something, and who plans in a dynamic frame."""
    interfaces: dict[str, list[Interface]] = {}
    for interface in cell.interfaces:
        interfaces.setdefault(interface.name, []).append(interface)
    commanders: dict[str, list[Controller]] = {}
    for controller in cell.controllers:
        if controller.command_interfaces:
            commanders.setdefault(controller.label, []).append(controller)
    return DataFlow(
        {name: tuple(items) for name, items in interfaces.items()},
        {name: tuple(items) for name, items in commanders.items()},
        _frame_edges(cell),
    )


def _frame_edges(cell: Cell) -> tuple[tuple[str, str], ...]:
    targets = {goal.frame for goal in cell.goals}
    publishers = [f.authority for f in cell.frames if f.kind is FrameKind.DYNAMIC and f.name in targets]
    clients = [controller.client for controller in cell.controllers if controller.client]
    return tuple(dict.fromkeys((publisher, client) for publisher in publishers for client in clients))


@dataclass(frozen=True, slots=True)
class AgeShare:
    """What one topic adds to the age of an observation, in s; a fresh sample is up to one period old.

    ``path`` is where the spec speaks of it. A node that executes callbacks adds a share, too, ``response_s`` alone.
    """

    topic: str
    path: YamlPath
    period_s: float = 0.0
    transport_s: float = 0.0
    exposure_s: float = 0.0
    response_s: float | None = None

    @property
    def total_s(self) -> float:
        """The whole share in s."""
        return self.period_s + self.transport_s + self.exposure_s + (self.response_s or 0.0)

    def __str__(self) -> str:
        return f"`{self.topic}` {self.total_s * 1e3:.4g} ms"


def age_chains(cell: Cell) -> Mapping[str, tuple[AgeShare, ...]]:
    """Return, for each topic with a rate, its shares of age from the sensor on, the sensor first.

    A node forwards the stamp of its input where its output is in the input's frame, as a detector does that publishes
    poses in the camera frame. Of several inputs the freshest counts: data too old by that one is too old by all.
    Topics that only feed each other in a circle observe nothing; each has its own share alone. A node between two
    topics, or at the end, adds how long it needs for a sample, as far as its executor and callbacks are stated.
    """
    topics = {topic.name: topic for topic in cell.interfaces if topic.kind is InterfaceKind.TOPIC and topic.rate_hz}
    shares = {name: age_share(cell, topic) for name, topic in topics.items()}
    passed_on = _passed_on(cell, topics)
    executed = _executed(cell, topics)
    observing = {name for names in passed_on.values() for name in names}
    queue = [(share.total_s, name, "", "") for name, share in shares.items() if name not in observing]
    heapify(queue)
    chains: dict[str, tuple[AgeShare, ...]] = {}
    while queue:
        age_s, name, before, by = heappop(queue)
        if name in chains:
            continue
        chains[name] = (*chains.get(before, ()), *executed.get((before, by), ()), shares[name])
        for output, node in passed_on[name].items():
            if output not in chains:
                needed_s = shares[output].total_s + sum(share.total_s for share in executed.get((name, node), ()))
                heappush(queue, (age_s + needed_s, output, name, node))
    return {name: (*chains.get(name, (share,)), *_last(executed, topics[name])) for name, share in shares.items()}


def _executed(cell: Cell, topics: Mapping[str, Interface]) -> Mapping[tuple[str, str], tuple[AgeShare, ...]]:
    """Return what nodes add to the age of a sample of a topic, by both, where the bound is known."""
    nodes = {node.full_name: node for node in stating(cell)}
    executed: dict[tuple[str, str], tuple[AgeShare, ...]] = {}
    for topic in topics.values() if nodes else ():
        for sink in topic.sinks:
            node = nodes.get(sink.full_name)
            bound_s = None if node is None or topic.derived else response(cell, node, topic.name).bound_s
            if node is not None and bound_s is not None:
                path = (*node.path, "callbacks")
                executed[topic.name, sink.node] = (AgeShare(sink.node, path, response_s=bound_s),)
    return executed


def _last(executed: Mapping[tuple[str, str], tuple[AgeShare, ...]], topic: Interface) -> tuple[AgeShare, ...]:
    """Return the share of the reader that needs the longest for a sample."""
    ends = (executed.get((topic.name, sink.node), ()) for sink in topic.sinks) if executed else iter(())
    return max(ends, key=lambda shares: sum(share.total_s for share in shares), default=())


def _passed_on(cell: Cell, topics: Mapping[str, Interface]) -> Mapping[str, Mapping[str, str]]:
    """Return, for each topic, the topics to which its readers pass its stamp on, with the node that does."""
    device_frames = {device.name: frozenset(device.body.frames.values()) for device in cell.devices}
    published: dict[str, list[Interface]] = {}
    for topic in topics.values():
        for source in topic.sources:
            published.setdefault(source.node, []).append(topic)
    passed_on: dict[str, dict[str, str]] = {}
    for name, topic in topics.items():
        frames = {topic.frame}.union(*(device_frames.get(source.node, ()) for source in topic.sources))
        passed_on[name] = {
            output.name: sink.node
            for sink in topic.sinks
            for output in published.get(sink.node, ())
            if output.frame is not None and output.frame in frames and output.name != name
        }
    return passed_on


def age_share(cell: Cell, topic: Interface) -> AgeShare:
    """Return how old a sample of one topic may be by its own period, transport and exposure."""
    period_s = 1.0 / topic.rate_hz if topic.rate_hz else 0.0
    exposures = (cell.exposure_of(source.node) for source in topic.sources)
    return AgeShare(topic.name, topic.path, period_s, topic.transport_s or 0.0, max(exposures, default=0.0))


@dataclass(frozen=True, slots=True)
class KnownTopics:
    """Topics that devices and controllers are known to have: full name → type, by the name of the end in the spec."""

    published: Mapping[str, Mapping[str, str]]
    subscribed: Mapping[str, Mapping[str, str]]


def known_topics(cell: Cell) -> KnownTopics:
    """Return what the drivers of devices publish, and what controllers publish and follow with their parameters."""
    published = {device.name: dict(device.topics) for device in cell.devices}
    subscribed: dict[str, dict[str, str]] = {}
    for controller in cell.controllers:
        for topic in controller.own_topics:
            ends = published if topic.publishes else subscribed
            ends.setdefault(controller.label, {})[topic.name] = topic.type
    for node in cell.nodes:
        types = program_types(cell, node) if node.source is NodeSource.SPEC else None
        # A parameter may give a topic another name.
        if types and not any(name.endswith("_topic") for name in node.parameters):
            own = set(node.endpoints.subscribes)
            subscribed.setdefault(node.name, {}).update(
                (name, type_) for key, (name, type_) in types.items() if own & {key, name}
            )
    return KnownTopics(published, subscribed)


def program_types(cell: Cell, node: Node) -> Mapping[str, tuple[str, str]] | None:
    """Return what the program of a node has, by its own names: full names and types; None where it is not known."""
    table = load_programs().value
    for program in () if table is None else table.programs:
        if (program.package, program.executable) == (node.package, node.executable):
            return {
                name: (node.full_name + name[1:] if name.startswith("~/") else f"{node.namespace}/{name}", type_)
                for name, type_ in program.types.items()
            }
    return None


def known_executables(package: str) -> tuple[str, ...]:
    """Name the programs of a package that the catalog knows."""
    table = load_programs().value
    programs = () if table is None else table.programs
    return tuple(program.executable for program in programs if program.package == package)


def is_state_on_change(topic: Interface) -> bool:
    """Tell whether a topic keeps its last sample for late readers and has no stamp: it holds until it is changed."""
    facts = interface_types().get(topic.type)
    latched = bool(topic.sources) and all(
        source.qos.durability == "transient_local" and source.qos.reliability == "reliable" for source in topic.sources
    )
    return latched and topic.rate_hz is None and facts is not None and not facts.stamped


def interface_types() -> Mapping[str, InterfaceTypeFacts]:
    """Return the known types by full name; a cell may use others of its own packages."""
    table = load_message_types().value
    return {} if table is None else table.types
