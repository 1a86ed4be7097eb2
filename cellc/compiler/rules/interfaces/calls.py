"""Rules on services and actions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from cellc.compiler.cell.interface import Interface, NodeSource
from cellc.compiler.graph.data_flow import program_types
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule, write
from cellc.contract.vocabulary import InterfaceKind


@rule(Severity.ERROR)
def action_without_cancel_bound(graph: CellGraph) -> Findings:
    """Yield actions of the spec without a bound from cancel to hold."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and not interface.derived and interface.cancel_within_s is None:
            message = f"action `{interface.name}` does not say how soon a cancel takes effect"
            yield found(graph, interface.path, message)


@rule(Severity.WARNING)
def call_without_client(graph: CellGraph) -> Findings:
    """Yield services and actions of the spec without a client."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.kind is not InterfaceKind.TOPIC and not interface.sinks:
            message = f"the {interface.kind.value} `{interface.name}` has no client"
            yield found(graph, (*interface.path, "client"), message)


@rule(Severity.ERROR)
def call_without_timeout_behavior(graph: CellGraph) -> Findings:
    """Yield services and actions of the spec without a behavior on timeout."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC or interface.derived or interface.on_timeout is not None:
            continue
        message = f"{interface.kind.value} `{interface.name}` does not say what happens when no answer comes"
        yield found(graph, interface.path, message)


_MOTION = frozenset(
    [
        "Move",
        "Motion",
        "Execute",
        "Trajectory",
        "Grip",
        "Grasp",
        "Pick",
        "Place",
        "Follow",
        "Servo",
        "Jog",
        "Home",
        "Dock",
    ]
)
_READING = ("Get", "Check", "Query", "Plan", "List", "Compute", "Set")


_SPEAKS_OF_NOTHING = ("std_srvs/srv/Trigger", "std_srvs/srv/SetBool", "std_srvs/srv/Empty")
"""Types whose meaning is in the name of the service."""
_ONLY_IN_NAMES = frozenset(["Go", "Goto", "Park", "Retract", "Approach", "Insert"])


@rule(Severity.ERROR)
def motion_over_service(graph: CellGraph) -> Findings:
    """Yield services whose type speaks of motion and does not merely read, plan or set.

    A type that says nothing is judged by the name of the service, where its server commands a controller.
    """
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.SERVICE or interface.derived:
            continue
        words, motion = re.findall(r"[A-Z][a-z]+", interface.type.rpartition("/")[2]), _MOTION
        if interface.type in _SPEAKS_OF_NOTHING and any(_commands(graph, end.node) for end in interface.sources):
            name = interface.name.rpartition("/")[2]
            words, motion = [word.title() for word in re.findall(r"[A-Za-z][a-z]*", name)], _MOTION | _ONLY_IN_NAMES
        if words and words[0] not in _READING and not motion.isdisjoint(words):
            message = f"`{interface.name}` requests motion over the service `{interface.type}`"
            yield found(graph, (*interface.path, "service"), message)


def _commands(graph: CellGraph, node: str) -> bool:
    """Tell whether a node itself is the client of a controller."""
    return any(controller.client == node for controller in graph.cell.controllers)


@rule(Severity.WARNING)
def motion_over_topic(graph: CellGraph) -> Findings:
    """Yield topics of the spec that end in a controller with command interfaces."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.kind is not InterfaceKind.TOPIC:
            continue
        for sink in interface.sinks:
            if sink.node in graph.data.commanders:
                message = f"controller `{sink.node}` is commanded over the topic `{interface.name}`"
                yield found(graph, sink.path, message)


@rule(Severity.ERROR)
def service_without_error_answer(graph: CellGraph) -> Findings:
    """Yield services of the spec without a stated error answer."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.SERVICE and not interface.derived and interface.on_error is None:
            message = f"service `{interface.name}` does not say how it reports an error"
            yield found(graph, interface.path, message)


@rule(Severity.ERROR)
def unbounded_action(graph: CellGraph) -> Findings:
    """Yield actions of the spec without a timeout."""
    for interface in _unbounded(graph, InterfaceKind.ACTION):
        yield found(graph, interface.path, f"action `{interface.name}` has no bound on a whole goal")


@rule(Severity.ERROR)
def unbounded_service(graph: CellGraph) -> Findings:
    """Yield services of the spec without a timeout."""
    for interface in _unbounded(graph, InterfaceKind.SERVICE):
        yield found(graph, interface.path, f"service `{interface.name}` has no bound on its response time")


def _unbounded(graph: CellGraph, kind: InterfaceKind) -> Iterator[Interface]:
    for interface in graph.cell.interfaces:
        if interface.kind is kind and not interface.derived and interface.timeout_s is None:
            yield interface


@rule(Severity.ERROR, assumes=("interface-kind-mismatch", "unknown-interface-type"))
def unoffered_call(graph: CellGraph) -> Findings:
    """Yield services and actions of the spec that their server has under another name, or with another type."""
    cell = graph.cell
    offered = {
        controller.label: {controller.action: controller.action_type or ""}
        for controller in cell.controllers
        if controller.action
    }
    for node in cell.nodes:
        types = program_types(cell, node) if node.source is NodeSource.SPEC else None
        own = {*node.endpoints.executes, *node.endpoints.serves}
        if types:
            offered[node.name] = {name: type_ for key, (name, type_) in types.items() if own & {key, name}}
    for interface in cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC or interface.derived:
            continue
        for end in interface.sources:
            yield from _unoffered(graph, interface, end.node, offered.get(end.node, {}))
        for end in interface.sinks:
            if interface.type in offered.get(end.node, {}).values() and all(
                source.node not in offered for source in interface.sources
            ):
                message = f"`{end.node}` answers `{interface.type}` itself and must be the server of `{interface.name}`"
                yield found(graph, (*interface.path, "server"), message)


def _unoffered(graph: CellGraph, interface: Interface, server: str, offers: Mapping[str, str]) -> Findings:
    kind, has = interface.kind.value, offers.get(interface.name)
    alike = [name for name, type_ in offers.items() if type_ == interface.type]
    if has is not None and has != interface.type and not _has_controller(graph, server):
        message = f"`{server}` has the {kind} `{interface.name}` with the type `{has}`, got `{interface.type}`"
        yield found(graph, (*interface.path, kind), message, write(has, interface.type))
    elif has is None and alike:
        message = f"`{server}` has no {kind} `{interface.name}`"
        advice = did_you_mean(interface.name, alike, f"{kind}s of `{server}` with `{interface.type}`")
        yield found(graph, interface.path, message, advice, tuple(_namespace(graph, server)))


def _namespace(graph: CellGraph, server: str) -> Iterator[Related]:
    """Yield where the namespace of a node is stated, in which its names lie."""
    for node in graph.cell.nodes:
        if node.name == server and graph.cell.states(*node.path, "namespace"):
            yield Related("its names lie in this namespace", graph.cell.locate(*node.path, "namespace"))


def _has_controller(graph: CellGraph, name: str) -> bool:
    """Whether a name is that of a controller, whose action is in the graph with its type anyway."""
    return any(controller.label == name for controller in graph.cell.controllers)
