"""The data flow: who tells what to whom, from sensors down to the controllers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from cellc.cell.cell import Cell
from cellc.cell.control import Controller
from cellc.cell.frame import FrameKind
from cellc.cell.interface import Endpoint, Interface, InterfaceKind

if TYPE_CHECKING:
    import networkx


@dataclass(frozen=True, slots=True)
class TopicPair:
    """A publisher of a topic and one of its subscribers, whose QoS the middleware compares."""

    topic: Interface
    source: Endpoint
    sink: Endpoint


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

    def topic_pairs(self) -> Iterator[TopicPair]:
        """Yield each publisher of a topic with each of its subscribers."""
        for interfaces in self.interfaces.values():
            topics = [interface for interface in interfaces if interface.kind is InterfaceKind.TOPIC]
            sources = [(topic, source) for topic in topics for source in topic.sources]
            sinks = [sink for topic in topics for sink in topic.sinks]
            for topic, source in sources:
                yield from (TopicPair(topic, source, sink) for sink in sinks)

    def path_to_motion(self, node: str) -> tuple[str, ...]:
        """Return the shortest way from a node to a controller, both included; empty where there is none."""
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
        {name: tuple(found) for name, found in interfaces.items()},
        {name: tuple(found) for name, found in commanders.items()},
        _frame_edges(cell),
    )


def _frame_edges(cell: Cell) -> tuple[tuple[str, str], ...]:
    targets = {goal.frame for goal in cell.goals}
    publishers = [f.authority for f in cell.frames if f.kind is FrameKind.DYNAMIC and f.name in targets]
    clients = [controller.client for controller in cell.controllers if controller.client]
    return tuple(dict.fromkeys((publisher, client) for publisher in publishers for client in clients))
