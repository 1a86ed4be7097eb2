"""Rules on names of nodes, interfaces and files."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule, write
from cellc.contract.file_names import opens_a_device
from cellc.contract.vocabulary import InterfaceKind


@rule(Severity.ERROR, assumes=("shared-manager-name",))
def duplicate_node_name(graph: CellGraph) -> Findings:
    """Yield nodes and controllers whose full name is taken."""
    named = [(node.full_name, node.path) for node in graph.cell.nodes]
    named += [(c.full_name, c.path) for c in graph.cell.controllers]
    first: dict[str, YamlPath] = {}
    for name, path in named:
        earlier = first.setdefault(name, path)
        if earlier != path:
            message = f"two nodes are named `{name}`"
            related = (Related("the first is here", graph.cell.locate(*earlier)),)
            yield found(graph, path, message, related=related)


@rule(Severity.ERROR)
def hidden_action_name(graph: CellGraph) -> Findings:
    """Yield names with the part `_action`."""
    for interface in graph.cell.interfaces:
        if "_action" in interface.name.split("/"):
            message = f"`{interface.name}` is a hidden name of an action"
            yield found(graph, interface.path, message)


_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
_LONGEST = {InterfaceKind.TOPIC: 247, InterfaceKind.SERVICE: 240, InterfaceKind.ACTION: 221}


@rule(Severity.ERROR)
def illegal_ros_name(graph: CellGraph) -> Findings:
    """Yield interfaces and recorded topics whose names are not full, hold other characters or are too long."""
    named = [(interface.path, interface.name, interface.kind) for interface in graph.cell.interfaces]
    recorded = enumerate(graph.cell.recording.topics)
    named += [(("recording", "topics", index), name, InterfaceKind.TOPIC) for index, name in recorded]
    for path, name, kind in named:
        if _NAME.fullmatch(name) is None:
            yield found(
                graph, path, f"`{name}` is not a legal ROS name", write(_legal(name), name, ", as the nodes do")
            )
        elif len(name) > _LONGEST[kind]:
            message = f"`{name[:40]}…` must have at most {_LONGEST[kind]} characters, got {len(name)}"
            yield found(graph, path, message, "shorten the name")


def _legal(name: str) -> str:
    """Return the nearest legal full name: other characters as `_`, and `_` before a digit that begins a part."""
    parts = (re.sub(r"[^A-Za-z0-9]+", "_", part).strip("_") for part in name.split("/"))
    return "".join(f"/_{part}" if part[0].isdigit() else f"/{part}" for part in parts if part) or "/name"


@rule(Severity.ERROR)
def reserved_file_name(graph: CellGraph) -> Findings:
    """Yield names that files are named after and that are devices of Windows."""
    for name, path in _file_names(graph):
        if opens_a_device(name):
            yield found(
                graph, path, f"`{name}` must not be the name of a file, because Windows reserves it for a device"
            )


def _file_names(graph: CellGraph) -> Iterator[tuple[str, YamlPath]]:
    """Yield each name that a file begins with, once for each place."""
    cell = graph.cell
    yield cell.name, ("cell",)
    yield from ((name, ("hosts", name)) for name in cell.hosts)
    named = {(device.name, device.path) for device in cell.devices}
    named |= {(manager.name, manager.path) for manager in cell.managers}
    # The file of a node begins with the first part of its full name; that of a device's node is often the device.
    names = {(node.full_name.split("/")[1], node.path) for node in cell.nodes}
    yield from sorted(named | names, key=str)
