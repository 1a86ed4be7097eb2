"""A file of ROS parameters: one section a node, each with the spec path that it came from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cellc.cell.interface import ParameterValue
from cellc.diagnostics import YamlPath
from cellc.formats.header import Header
from cellc.formats.yaml_text import nested, render

ANY_NODE = "/**"
"""Matches every node that reads the file."""


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
