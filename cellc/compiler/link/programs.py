"""What nodes have at the ROS graph without mention in the cell: by what they are, and by the program that runs them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields, replace
from typing import TypeVar

from cellc.compiler.catalog.load import load_programs
from cellc.compiler.catalog.programs import EndpointFacts, ImpliedFacts, InnerNodeFacts, NodeKind, ProgramTable
from cellc.compiler.cell.interface import ImpliedEndpoints, InnerNode, Node, NodeEndpoints, NodeSource
from cellc.contract.vocabulary import Distro

_FactsT = TypeVar("_FactsT", bound=ImpliedFacts)


def _table() -> ProgramTable:
    table = load_programs().value
    assert table is not None  # package data, held valid by the catalog's tests
    return table


def implied_endpoints(distro: Distro) -> ImpliedEndpoints:
    """Return what nodes of each kind have in a distribution."""

    def of(kind: NodeKind) -> NodeEndpoints:
        return _together(endpoints(facts) for facts in _here(_table().implied[kind], distro))

    return ImpliedEndpoints(
        node=of("node"),
        lifecycle=of("lifecycle"),
        controller=of("controller"),
        component=of("component"),
        transforms=of("transforms"),
    )


def with_programs(nodes: Iterable[Node], distro: Distro) -> Iterator[Node]:
    """Yield nodes with what the catalog knows of their programs; a device tells of its own."""
    known = {(program.package, program.executable): program.nodes for program in _table().programs}
    for node in nodes:
        facts = known.get((node.package, node.executable), ())
        yield node if node.source is NodeSource.DEVICE or not facts else _with(node, facts, distro)


def _with(node: Node, facts: Iterable[InnerNodeFacts], distro: Distro) -> Node:
    nodes = inner_nodes(facts, node.namespace, distro, lambda text: text.replace("{node}", node.full_name))
    stated = [item for item in nodes if item.full_name == node.full_name]
    return replace(
        node,
        endpoints=_together((node.endpoints, *(node.endpoints for node in stated))),
        inside=tuple(node for node in nodes if node not in stated),
    )


def inner_nodes(
    facts: Iterable[InnerNodeFacts], namespace: str, distro: Distro | None, fill: Callable[[str], str]
) -> tuple[InnerNode, ...]:
    """Return the nodes of a process in a distribution, their names absolute but for those below their own.

    Args:
        namespace: that of the process, in which relative names lie.
        fill: puts values in the place of what a text leaves open.
    """
    nodes = []
    for item in _here(facts, distro):
        name = _absolute(fill(item.name), namespace)
        endpoint_names = {key: _absolute_all(names, name) for key, names in _names(endpoints(item, fill)).items()}
        nodes.append(InnerNode(full_name=name, endpoints=NodeEndpoints(**endpoint_names), parameters=item.parameters))
    return tuple(nodes)


def endpoints(facts: EndpointFacts | None, fill: Callable[[str], str] = str) -> NodeEndpoints:
    """Return what a program has at the graph, by its own names."""
    if facts is None:
        return NodeEndpoints()
    return NodeEndpoints(
        **{field.name: tuple(map(fill, getattr(facts, field.name))) for field in fields(NodeEndpoints)}
    )


def _together(several: Iterable[NodeEndpoints]) -> NodeEndpoints:
    listed = [_names(endpoints) for endpoints in several]
    return NodeEndpoints(
        **{field.name: tuple(name for names in listed for name in names[field.name]) for field in fields(NodeEndpoints)}
    )


def _names(one: NodeEndpoints) -> dict[str, tuple[str, ...]]:
    return {field.name: getattr(one, field.name) for field in fields(NodeEndpoints)}


def _absolute_all(names: Iterable[str], node: str) -> tuple[str, ...]:
    home = node.rpartition("/")[0]
    return tuple(name if name.startswith("~") else _absolute(name, home) for name in names)


def _absolute(name: str, namespace: str) -> str:
    return name if name.startswith("/") else f"{namespace}/{name}"


def _here(facts: Iterable[_FactsT], distro: Distro | None) -> Iterator[_FactsT]:
    return (fact for fact in facts if not fact.only or distro in fact.only)
