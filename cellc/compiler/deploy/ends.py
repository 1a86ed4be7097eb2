"""Who publishes and serves, and who subscribes and calls, on a target: what its ROS graph must show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.cell.interface import Interface, Node
from cellc.compiler.deploy.readiness import silent_until_activation
from cellc.compiler.deploy.watches import watches
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.bring_up import CLAIM_WATCH
from cellc.contract.entities import Target
from cellc.contract.vocabulary import InterfaceKind


def ends_on(graph: CellGraph, interface: Interface, target: Target) -> tuple[Mapping[str, str], Mapping[str, str]]:
    """Return the publishers or servers of an interface on a target, and its subscribers or clients.

    A driver's node listens to the controllers of its robot, the stopper of claims to what it watches, and a planner has
    a client of each action that it executes on. A person who compares the graph with the page finds them all.

    Returns:
        Full name → the gate that starts it, empty where the first launch does.
    """
    from_gate = dict.fromkeys(graph.once(silent) if target == "real" else (), "G5")
    from_gate |= dict.fromkeys(graph.cell.started_late, "G7")

    def named(ends: Iterable[str]) -> dict[str, str]:
        return {full_name: from_gate.get(full_name, "") for full_name in ends}

    absent = graph.once(_real_only) if target == "mock" else frozenset[str]()
    sides = (
        [end.full_name for end in ends if target in end.targets and end.full_name not in absent]
        for ends in (interface.sources, interface.sinks)
    )
    sources, sinks = map(named, sides)
    return sources, sinks | dict.fromkeys((name for name in _beside(graph, interface, target) if name not in sinks), "")


def silent(graph: CellGraph) -> frozenset[str]:
    """Return the full names of what runs only once a person has activated hardware."""
    return silent_until_activation(graph.cell)


def is_late(graph: CellGraph, interface: Interface) -> bool:
    """Whether no node publishes or serves an interface before a person has activated hardware."""
    late = graph.once(silent)
    return bool(interface.sources) and all(end.full_name in late for end in interface.sources)


def _beside(graph: CellGraph, interface: Interface, target: Target) -> Iterator[str]:
    """Yield subscribers and clients that the spec does not name."""
    for node in graph.once(_asking).get((interface.kind, interface.name), ()):
        if target == "real" or not node.real_only:
            yield node.full_name
    if target == "real" and interface.name in graph.once(_watched):
        yield CLAIM_WATCH


def _real_only(graph: CellGraph) -> frozenset[str]:
    return frozenset(node.full_name for node in graph.cell.nodes if node.real_only)


def _asking(graph: CellGraph) -> Mapping[tuple[InterfaceKind, str], list[Node]]:
    """Return the nodes that subscribe to each topic, and that call each service."""
    asking: dict[tuple[InterfaceKind, str], list[Node]] = {}
    for node in graph.cell.nodes:
        ends = {InterfaceKind.TOPIC: node.endpoints.subscribes, InterfaceKind.SERVICE: node.endpoints.requests}
        for kind, asked in ends.items():
            for name in {node.remaps.get(text, text) for text in asked}:
                asking.setdefault((kind, name), []).append(node)
    return asking


def _watched(graph: CellGraph) -> frozenset[str]:
    return frozenset(proof.topic for watch in watches(graph.cell) for proof in watch.while_hold.values())
