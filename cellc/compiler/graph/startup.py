"""The start-up graph: which part must be ready before which."""

from __future__ import annotations

from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

from cellc.compiler.cell.cell import Cell
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import InterfaceKind


@dataclass(frozen=True, slots=True)
class Need:
    """One part waits for another; ``proof`` is the interface whose presence shows that the other is ready."""

    part: str
    needs: str
    proof: str


@dataclass(frozen=True, slots=True)
class StartupGraph:
    """What each part waits for: servers, managers and action servers, never a mere process.

    Topics are no edges: a node may subscribe before there is a publisher, and feedback loops over topics are legal.
    """

    parts: tuple[str, ...]
    needs: tuple[Need, ...]

    def cycle(self) -> tuple[str, ...]:
        """Return one circle of parts that wait for each other, or nothing."""
        try:
            TopologicalSorter(self._predecessors()).prepare()
        except CycleError:
            return self._find_cycle()
        return ()

    def order(self) -> tuple[str, ...]:
        """Return every part after all that it needs, otherwise in alphabetical order.

        Raises:
            networkx.NetworkXUnfeasible: there is a cycle.
        """
        import networkx

        graph: networkx.DiGraph[str] = networkx.DiGraph()
        graph.add_nodes_from(self.parts)
        graph.add_edges_from((need.needs, need.part) for need in self.needs)
        return tuple(networkx.lexicographical_topological_sort(graph))

    def _predecessors(self) -> Mapping[str, list[str]]:
        predecessors: dict[str, list[str]] = {part: [] for part in self.parts}
        for need in self.needs:
            predecessors.setdefault(need.part, []).append(need.needs)
        return predecessors

    def _find_cycle(self) -> tuple[str, ...]:
        import networkx

        graph: networkx.DiGraph[str] = networkx.DiGraph()
        graph.add_edges_from(sorted((need.part, need.needs) for need in self.needs))
        components = (c for c in networkx.strongly_connected_components(graph) if len(c) > 1)
        first = min((min(component) for component in components), default=None)
        if first is None:
            return tuple(sorted(part for part in graph if graph.has_edge(part, part)))[:1]
        return tuple(edge[0] for edge in networkx.find_cycle(graph, first))


def build_startup(cell: Cell) -> StartupGraph:
    """Gather who waits for whom: clients for servers, controllers for their manager, clients for controllers."""
    needs: dict[Need, None] = {}
    for controller in cell.controllers:
        manager = f"{controller.namespace}/controller_manager"
        needs[Need(controller.label, manager, f"{manager}/list_controllers")] = None
        if controller.client and controller.action:
            needs[Need(controller.client, controller.label, controller.action)] = None
    for interface in cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC:
            pairs = ((sink.node, source.node) for source in interface.sources for sink in interface.sinks)
            needs.update({Need(client, server, interface.name): None for client, server in pairs})
    parts = dict.fromkeys(node.name for node in cell.nodes)
    parts.update(dict.fromkeys(part for need in needs for part in (need.part, need.needs)))
    return StartupGraph(tuple(parts), tuple(needs))
