"""``config/<node>.yaml``: parameters of the nodes that the spec names and of the devices' drivers.

ROS parameter file, one a node, because each is read by another process. Left out: nodes without parameters, and the
controller manager, whose file is the controllers' own.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.deploy.files import node_file
from cellc.formats.header import Header
from cellc.formats.parameter_file import NodeParameters, parameter_file
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield a parameter file for each node that has parameters."""
    for node in graph.cell.nodes:
        if node.parameters:
            section = NodeParameters(node.full_name, node.path, node.parameters)
            yield Artifact(node_file(node), parameter_file(header, [section]))
