"""Nodes of the launch file that are no part of control."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.interface import Node, NodeSource
from cellc.deploy.files import (
    QOS_OVERRIDES,
    description_file,
    is_planner,
    node_file,
    parameter_files,
    plans,
    semantic_file,
)
from cellc.deploy.labels import TF_RATE_HZ
from cellc.deploy.processes import host_of, launch_hosts
from cellc.emit.launch.elements import description_parameter, identity, remaps
from cellc.emit.launch.substitutions import ON_REAL, TARGET, on_host, share
from cellc.formats.numbers import decimal
from cellc.formats.parameter_file import qos_parameters
from cellc.formats.xml_text import element


def robot_state_publisher(cell: Cell, node: Node) -> Element:
    """Return the one authority for all static frames."""
    # Said though it is the default: what reads /tf is promised this rate.
    rate = element("param", {"name": "publish_frequency", "value": decimal(TF_RATE_HZ)})
    return element("node", identity(cell, node), [_description(cell), rate])


def cell_node(cell: Cell, node: Node) -> Element:
    """Return a node that the spec names."""
    return element("node", identity(cell, node), _parameters(cell, node))


def driver_node(cell: Cell, node: Node) -> Element:
    """Return a node of a device's driver; one for real hardware alone stays away from the mock."""
    condition = {"if": ON_REAL} if node.real_only else {}
    return element("node", identity(cell, node) | condition, _parameters(cell, node))


def moving_node(cell: Cell, node: Node, prefix: str) -> Element:
    """Return a node that asks for motion, behind a prefix that waits until everything is ready for it."""
    hosts = launch_hosts(cell)
    place = {"if": on_host(host_of(cell, node))} if hosts else {}
    return element("node", identity(cell, node) | {"launch-prefix": prefix} | place, _parameters(cell, node))


def _parameters(cell: Cell, node: Node) -> Iterator[Element]:
    if is_planner(node) and plans(cell):
        yield _description(cell)
        semantic = f"$(command 'cat {share(cell, semantic_file(cell))}')"
        yield element("param", {"name": "robot_description_semantic", "value": semantic, "type": "str"})
        yield from (element("param", {"from": share(cell, file)}) for file in parameter_files(cell, TARGET))
    if node.parameters:
        yield element("param", {"from": share(cell, node_file(node))})
    if node.source is NodeSource.SPEC and qos_parameters(cell, node):
        yield element("param", {"from": share(cell, QOS_OVERRIDES)})
    if node.clock == "sim":
        yield element("param", {"name": "use_sim_time", "value": "true"})
    yield from remaps(node)


def _description(cell: Cell) -> Element:
    return description_parameter(share(cell, description_file(cell, TARGET)))
