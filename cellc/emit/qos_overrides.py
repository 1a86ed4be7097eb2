"""``config/qos_overrides.yaml``: the QoS of the contract, for nodes that let parameters override it.

ROS parameter file with the names of rclcpp's QosOverridingOptions, durations in nanoseconds. A node whose author passed
no such options ignores it without a word: gate L4 looks at what the endpoints really offer. Left out: controllers and
the controller manager, which allow no override, and interfaces that the spec does not write.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.interface import NodeSource
from cellc.deploy.files import QOS_OVERRIDES
from cellc.formats.header import Header
from cellc.formats.parameter_file import NodeParameters, parameter_file, qos_parameters
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the overrides of the nodes that the spec names."""
    sections = [
        NodeParameters(node.full_name, node.path, parameters)
        for node in graph.cell.nodes
        if node.source is NodeSource.SPEC and (parameters := qos_parameters(graph.cell, node))
    ]
    if sections:
        yield Artifact(QOS_OVERRIDES, parameter_file(header, sections))
