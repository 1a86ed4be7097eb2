"""Controller managers and their spawners in the launch file.

A manager takes all hardware of the description that it is given. The one manager of a cell takes the cell's. Of
several, each has a description with its own hardware alone, on a topic of its own; their joint states are merged for
the rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.emit.launch.elements import description_parameter, enclave, remap
from cellc.emit.launch.substitutions import ON_REAL, TARGET, share
from cellc.formats.enclaves import manager_enclave, spawner_enclave
from cellc.formats.package_files import controllers_file, manager_description_file
from cellc.formats.spawning import spawnings
from cellc.formats.xml_text import element

_TOPIC = "robot_description"


def control(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield the processes of one update loop: one for its description where it has its own, and the loop."""
    namespace = ""
    if len(cell.managers) > 1:
        namespace = manager.namespace or f"/{manager.name}"
        yield _description_publisher(cell, manager, namespace)
    yield _manager(cell, manager, f"{namespace}/{_TOPIC}")


def joint_state_merger(cell: Cell) -> Element:
    """Return the node that gathers the joint states of several managers on ``/joint_states``.

    It has the whole description, so that it repeats every joint at the rate of the slowest manager.
    """
    sources = ",".join(f"'{manager.namespace}/joint_states'" for manager in cell.managers)
    rate = round(min(manager.update_rate_hz for manager in cell.managers))
    return element(
        "node",
        {
            "pkg": "joint_state_publisher",
            "exec": "joint_state_publisher",
            "name": "joint_state_merger",
            "output": "both",
            **enclave(f"/{cell.name}/joint_state_merger"),
        },
        [
            element("param", {"name": "source_list", "value": f"[{sources}]"}),
            element("param", {"name": "rate", "value": str(rate)}),
        ],
    )


def _description_publisher(cell: Cell, manager: ControllerManager, namespace: str) -> Element:
    # It says the description alone: the transforms of robot_state_publisher must stay the only ones.
    apart = [remap(topic, f"{namespace}/unused{topic}") for topic in ("/tf", "/tf_static")]
    return element(
        "node",
        {
            "pkg": "robot_state_publisher",
            "exec": "robot_state_publisher",
            "name": "description_publisher",
            "namespace": namespace,
            "output": "both",
            **enclave(f"/{cell.name}{namespace}/description_publisher"),
        },
        [description_parameter(share(cell, manager_description_file(cell, manager, TARGET))), *apart],
    )


def _manager(cell: Cell, manager: ControllerManager, topic: str) -> Element:
    # Without a name: it would apply to the nodes of the hardware as well.
    place = {"namespace": manager.namespace} if manager.namespace else {}
    parameters = [element("param", {"from": share(cell, controllers_file(cell, manager))})]
    if cell.distro == "humble":  # later ones take the description from its topic
        parameters.append(description_parameter(share(cell, manager_description_file(cell, manager, TARGET))))
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
        ],
    )


def spawners(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield what loads and configures a manager's controllers; it waits for the manager, and activates nothing.

    One process for all: several of them race for a controller that the manager has found in its file (Humble 2.54).
    """
    for one in spawnings(cell, manager):
        yield element(
            "node",
            {
                "pkg": "controller_manager",
                "exec": "spawner",
                "args": " ".join([*one.controllers, "-c", f"{manager.namespace}/controller_manager", "--inactive"]),
                "output": "both",
                **enclave(spawner_enclave(cell, manager)),
                **({"unless": ON_REAL} if one.mock_alone else {}),
            },
        )
