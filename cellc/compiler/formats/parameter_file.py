"""A file of ROS parameters: one section a node, each with its path in the spec; QoS as such parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Node, NodeSource, ParameterValue
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.yaml_text import nested, render
from cellc.contract.diagnostics import YamlPath
from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import InterfaceKind

ANY_NODE = "/**"
"""Matches every node that reads the file."""

_NANOSECONDS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class NodeParameters:
    """Parameters of one node; dots in a name become nesting.

    Args:
        node: fully qualified name, with its leading slash.
        origin: where the spec speaks of it.
    """

    node: str
    origin: YamlPath
    parameters: Mapping[str, ParameterValue]


def parameter_file(header: Header, sections: Iterable[NodeParameters]) -> str:
    """Write the sections in order; a node without parameters gets none, because an empty one is refused."""
    return header.commented("#") + "\n".join(_section(section) for section in sections if section.parameters)


def spec_path(path: YamlPath) -> str:
    """Return a place of the spec as people write it: ``control.controllers.arm_trajectory``."""
    return ".".join(str(part) for part in path)


def _section(section: NodeParameters) -> str:
    # A plain key matches the root namespace alone, a key with its leading slash matches exactly its node.
    plain = section.node.count("/") == 1 and section.node != ANY_NODE
    key = section.node.removeprefix("/") if plain else section.node
    return f"# {spec_path(section.origin)}\n" + render({key: {"ros__parameters": nested(section.parameters)}})


def node_parameters(cell: Cell, node: Node) -> dict[str, ParameterValue]:
    """Return the parameters of a node, with the QoS of the topics that the spec writes where it names the node."""
    overrides = qos_parameters(cell, node) if node.source is NodeSource.SPEC else {}
    return {**node.parameters, **overrides}


def qos_parameters(cell: Cell, node: Node) -> dict[str, ParameterValue]:
    """Return the overrides of a node for the topics that the spec writes; none for one that has no end there."""
    parameters: dict[str, ParameterValue] = {}
    for end in cell.ends_of.get(node.full_name, ()):
        topic = end.interface
        if topic.kind is not InterfaceKind.TOPIC or topic.derived:
            continue
        side = "publisher" if end.serves else "subscription"
        prefix = f"qos_overrides.{topic.name}.{side}"
        parameters |= {f"{prefix}.{policy}": value for policy, value in _policies(end.end.qos, side)}
    return parameters


def _policies(qos: Qos, side: str) -> Iterator[tuple[str, ParameterValue]]:
    yield "reliability", qos.reliability
    yield "durability", qos.durability
    yield "history", qos.history
    yield "depth", qos.depth
    yield "liveliness", qos.liveliness
    durations = {"deadline": qos.deadline_s, "liveliness_lease_duration": qos.lease_duration_s}
    if side == "publisher":  # a lifespan belongs to the sample's writer
        durations["lifespan"] = qos.lifespan_s
    for name, seconds in durations.items():
        if seconds is not None:
            yield name, round(seconds * _NANOSECONDS)
