"""Controller managers and their spawners in the launch file.

A manager takes all hardware of the description that it is given. The one manager of a cell takes the cell's. Of
several, each has a description with its own hardware alone, on a topic of its own. All report joints on one topic.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.cell.interface import Node
from cellc.deploy.bringup import spawnings
from cellc.deploy.files import controllers_file, manager_description_file
from cellc.deploy.processes import manager_enclave, spawner_enclave
from cellc.emit.launch.elements import description_parameter, enclave, identity, remap, remaps
from cellc.emit.launch.substitutions import TARGET, only_on, share
from cellc.formats.xml_text import element
from cellc.link.nodes import DESCRIPTION_PUBLISHER, description_home

_TOPIC = "robot_description"


def control(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield the processes of one update loop: one for its description where it has its own, and the loop."""
    own = (node for node in cell.nodes if node.name == DESCRIPTION_PUBLISHER and node.path == manager.path)
    yield from (_description_publisher(cell, manager, node) for node in own)
    yield _manager(cell, manager)


def _description_publisher(cell: Cell, manager: ControllerManager, node: Node) -> Element:
    description = description_parameter(share(cell, manager_description_file(cell, manager, TARGET)))
    return element("node", identity(cell, node), [description, *remaps(node)])


def _manager(cell: Cell, manager: ControllerManager) -> Element:
    # Without a name: it would apply to the nodes of the hardware as well.
    place = {"namespace": manager.namespace} if manager.namespace else {}
    parameters = [element("param", {"from": share(cell, controllers_file(cell, manager))})]
    if cell.distro == "humble":  # later ones take the description from its topic
        parameters.append(description_parameter(share(cell, manager_description_file(cell, manager, TARGET))))
    topic = f"{description_home(manager) if len(cell.managers) > 1 else ''}/{_TOPIC}"
    (node,) = (node for node in cell.nodes if node.full_name == manager.node)
    return element(
        "node",
        {
            "pkg": "controller_manager",
            "exec": "ros2_control_node",
            **place,
            "output": "both",
            **enclave(manager_enclave(cell, manager)),
        },
        [
            *parameters,
            remap(f"~/{_TOPIC}", topic),
            *([] if topic == f"/{_TOPIC}" and not place else [remap(_TOPIC, topic)]),
            *remaps(node),
        ],
    )


def spawners(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield what loads and configures a manager's controllers; it waits for the manager, and activates nothing.

    One process for all: several of them race for a controller that the manager has found in its file (Humble 2.54).
    """
    for one in spawnings(manager):
        yield element(
            "node",
            {
                "pkg": "controller_manager",
                "exec": "spawner",
                "args": " ".join([*one.controllers, "-c", manager.node, "--inactive"]),
                "output": "both",
                **enclave(spawner_enclave(cell, manager)),
                **only_on(one.only),
            },
        )
