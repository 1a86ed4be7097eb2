"""``launch/cell.launch.xml``: starts the cell on the mock, or on real hardware up to where a human takes over.

Launch XML for ``ros2 launch``, Humble to Lyrical: only actions and substitutions that all of them know. It discovers,
configures, observes and claims; it enables no drive and requests no motion, on any target. The real target includes
``real_gate.launch.xml``, whose argument has no default: launching stops there unless a person gives it. Left out:
transitions of managed nodes, which are steps of the bring-up, and hosts: it starts what the spec puts on any of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.cell.interface import NodeSource
from cellc.emit.launch.arguments import address_arguments, gate_argument, target_argument
from cellc.emit.launch.control import control, joint_state_merger
from cellc.emit.launch.nodes import cell_node, driver_node, robot_state_publisher
from cellc.emit.launch.substitutions import ON_REAL, share
from cellc.formats.header import Header
from cellc.formats.parameter_file import spec_path
from cellc.formats.xml_text import comment, element, render
from cellc.graph.cell_graph import CellGraph

_VERSION = {"version": "0.1.1"}
_GATE = "launch/real_gate.launch.xml"


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the launch file of the cell and the gate before its real target."""
    cell = graph.cell
    yield Artifact("launch/cell.launch.xml", render(element("launch", _VERSION, _actions(cell)), header.text))
    yield Artifact(_GATE, render(element("launch", _VERSION, [gate_argument()]), header.text))


def _actions(cell: Cell) -> Iterator[Element]:
    yield target_argument()
    yield from address_arguments(cell)
    yield comment("the gate before real hardware: without its argument nothing below is started")
    yield element("include", {"file": share(cell, _GATE), "if": ON_REAL})
    yield comment("discover and observe: the model, static frames and joint states")
    yield robot_state_publisher(cell)
    for manager in cell.managers:
        yield comment(f"{spec_path(manager.path)}: claims follow the order of the spec, alternates stay inactive")
        yield from control(cell, manager)
    if len(cell.managers) > 1:
        yield joint_state_merger(cell)
    for node in cell.nodes:
        if node.source is NodeSource.SPEC:
            yield comment(spec_path(node.path) + (": managed, left unconfigured" if node.lifecycle else ""))
            yield cell_node(cell, node)
        elif node.source is NodeSource.DEVICE:
            yield comment(f"driver of {spec_path(node.path)}")
            yield driver_node(cell, node)
