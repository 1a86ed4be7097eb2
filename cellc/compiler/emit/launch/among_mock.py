"""``launch/among_mock.launch.xml``: nodes of the spec beside a cell that ``cellc mock --ros`` plays, and no robot.

Whatever the shell has, they are on the domain of the mock and on this host alone. Each is started where its argument
says so, with the parameters of the package, on the time of the mock. Nothing waits: the mock offers what they need.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Node
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import AMONG_MOCK
from cellc.compiler.deploy.processes import beside_mock
from cellc.compiler.emit.launch.launch import argument
from cellc.compiler.emit.launch.processes import identity, parameters
from cellc.compiler.formats.escape import launch_text
from cellc.compiler.formats.parameter_file import spec_path
from cellc.compiler.formats.xml_text import comment, element, render
from cellc.compiler.graph.cell_graph import CellGraph

_ENVIRONMENT = {
    "ROS_DOMAIN_ID": "$(env CELLC_MOCK_DOMAIN 100)",  # cellc sets it for what it starts
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    "ROS_LOCALHOST_ONLY": "1",  # Humble knows no range
}
"""Discovery of Humble to Lyrical: https://docs.ros.org/en/jazzy/Tutorials/Advanced/Improved-Dynamic-Discovery.html"""


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the file where the spec names nodes that the mock can leave out."""
    if nodes := beside_mock(graph.cell):
        launch = element("launch", {"version": "0.1.1"}, _actions(graph.cell, nodes))
        yield Artifact(AMONG_MOCK, render(launch, plan.header.text))


def _actions(cell: Cell, nodes: tuple[Node, ...]) -> Iterator[Element]:
    for name in map(_key, nodes):
        yield argument(name, "false", f"Whether {name} runs for real.", "false", "true")
        yield argument(f"{name}_args", "", f"Arguments of the program of {name}.")
    yield comment("the domain of the mock, on this host alone; its time")
    for name, value in _ENVIRONMENT.items():
        yield element("set_env", {"name": name, "value": value})
    yield element("set_parameter", {"name": "use_sim_time", "value": "true"})
    for node in nodes:
        yield comment(spec_path(node.path))
        name = launch_text(_key(node))
        more = {"args": f"$(var {name}_args)", "if": f"$(var {name})"}
        yield element("node", identity(cell, node) | more, parameters(cell, node))


def _key(node: Node) -> str:
    """Return the key of a node in the spec: its name may be that of another one in another namespace."""
    return str(node.path[-1])
