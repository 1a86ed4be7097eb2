"""Elements that several nodes of the launch file have."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.interface import Node
from cellc.deploy.processes import enclave_of
from cellc.emit.launch.substitutions import expanded
from cellc.formats.xml_text import element


def enclave(path: str) -> dict[str, str]:
    """Return the attribute that puts a process into its enclave.

    Without security it has no effect; with it, a process outside of its enclave is denied everything.
    """
    return {"ros_args": f"--enclave {path}"}


def description_parameter(file: str) -> Element:
    """Return the parameter that holds a description of the package, its type stated so that nobody parses it."""
    return element("param", {"name": "robot_description", "value": expanded(file), "type": "str"})


def remap(source: str, target: str) -> Element:
    """Return ``<remap>``."""
    return element("remap", {"from": source, "to": target})


def remaps(node: Node) -> Iterator[Element]:
    """Yield the remaps of a node, from the names that its program has in its namespace."""
    return (remap(source, target) for source, target in node.remaps.items())


def identity(cell: Cell, node: Node) -> dict[str, str]:
    """Return the attributes that say what a node is: its program, names, output and enclave."""
    place = {"namespace": node.namespace} if node.namespace else {}
    again = {"respawn": "true"} if node.respawn else {}
    return {
        "pkg": node.package,
        "exec": node.executable,
        "name": node.name,
        **place,
        "output": "both",
        **again,
        **enclave(enclave_of(cell, node)),
    }
