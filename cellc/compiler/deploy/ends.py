"""Who publishes and serves, and who subscribes and calls, on the real target: what its ROS graph must show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.deploy.readiness import silent_until_activation
from cellc.compiler.deploy.watches import watches
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.bring_up import CLAIM_WATCH
from cellc.contract.vocabulary import InterfaceKind


def ends_on_real(graph: CellGraph, interface: Interface) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the full names of publishers or servers, and of subscribers or clients, on the real target.

    A driver's node listens to the controllers of its robot, the stopper of claims to what it watches, and a planner has
    a client of each action that it executes on. A person who compares the graph with the page finds them all.
    """
    from_gate = dict.fromkeys(graph.once(silent), "G5") | dict.fromkeys(graph.cell.started_late, "G7")

    def named(ends: tuple[Endpoint, ...]) -> Iterator[str]:
        for end in ends:
            if "real" in end.targets:
                gate = from_gate.get(end.full_name)
                yield end.full_name + (f" (from {gate} on)" if gate else "")

    sinks = dict.fromkeys((*named(interface.sinks), *_beside(graph, interface)))
    return tuple(dict.fromkeys(named(interface.sources))), tuple(sinks)


def silent(graph: CellGraph) -> frozenset[str]:
    """Return the full names of what runs only once a person has activated hardware."""
    return silent_until_activation(graph.cell)


def is_late(graph: CellGraph, interface: Interface) -> bool:
    """Whether no node publishes or serves an interface before a person has activated hardware."""
    late = graph.once(silent)
    return bool(interface.sources) and all(end.full_name in late for end in interface.sources)


def _beside(graph: CellGraph, interface: Interface) -> Iterator[str]:
    """Yield subscribers and clients that the spec does not name."""
    yield from graph.once(_asking).get((interface.kind, interface.name), ())
    if interface.name in graph.once(_watched):
        yield CLAIM_WATCH


def _asking(graph: CellGraph) -> Mapping[tuple[InterfaceKind, str], list[str]]:
    """Return the nodes that subscribe to each topic, and that call each service."""
    asking: dict[tuple[InterfaceKind, str], list[str]] = {}
    for node in graph.cell.nodes:
        ends = {InterfaceKind.TOPIC: node.endpoints.subscribes, InterfaceKind.SERVICE: node.endpoints.requests}
        for kind, asked in ends.items():
            for name in {node.remaps.get(text, text) for text in asked}:
                asking.setdefault((kind, name), []).append(node.full_name)
    return asking


def _watched(graph: CellGraph) -> frozenset[str]:
    return frozenset(proof.topic for watch in watches(graph.cell) for proof in watch.while_hold.values())
