"""Nodes of the launch file."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.cell.interface import Node, NodeSource
from cellc.emit.launch.substitutions import ON_REAL, description, share
from cellc.formats.enclaves import enclave_of, manager_enclave, spawner_enclave
from cellc.formats.moveit_files import PARAMETER_FILES, is_planner, semantic_file
from cellc.formats.package_files import QOS_OVERRIDES, controllers_file, node_file
from cellc.formats.qos_parameters import qos_parameters
from cellc.formats.xml_text import element

_DESCRIPTION_TOPIC = "/robot_description"


def robot_state_publisher(cell: Cell) -> Element:
    """Return the one authority for all static frames."""
    namespaces = {manager.namespace for manager in cell.managers}
    # It listens in the root namespace; a manager elsewhere publishes its joint states there.
    remaps = [_remap("joint_states", f"{name}/joint_states") for name in sorted(namespaces) if name]
    return element(
        "node",
        {
            "pkg": "robot_state_publisher",
            "exec": "robot_state_publisher",
            "name": "robot_state_publisher",
            "output": "both",
            **_enclave(f"/{cell.name}/robot_state_publisher"),
        },
        [_description_parameter(cell), *(remaps if len(namespaces) == 1 else [])],
    )


def controller_manager(cell: Cell, manager: ControllerManager) -> Element:
    """Return the update loop; its node keeps its own name, because a name would apply to hardware nodes as well."""
    place = {"namespace": manager.namespace} if manager.namespace else {}
    parameters = [element("param", {"from": share(cell, controllers_file(cell, manager))})]
    if cell.distro == "humble":  # later ones take the description from its topic
        parameters.append(_description_parameter(cell))
    return element(
        "node",
        {
            "pkg": "controller_manager",
            "exec": "ros2_control_node",
            **place,
            "output": "both",
            **_enclave(manager_enclave(cell, manager)),
        },
        [
            *parameters,
            _remap("~/robot_description", _DESCRIPTION_TOPIC),
            *([_remap("robot_description", _DESCRIPTION_TOPIC)] if manager.namespace else []),
        ],
    )


def spawners(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield one spawner for the active controllers, in order, and one for their alternates, which stay inactive."""
    active = [controller.name for controller in manager.controllers if controller.active]
    inactive = [controller.name for controller in manager.controllers if not controller.active]
    for names, flags in ((active, []), (inactive, ["--inactive"])):
        if names:
            arguments = [*names, "-c", f"{manager.namespace}/controller_manager", *flags]
            yield element(
                "node",
                {
                    "pkg": "controller_manager",
                    "exec": "spawner",
                    "args": " ".join(arguments),
                    "output": "both",
                    **_enclave(spawner_enclave(cell, manager)),
                },
            )


def cell_node(cell: Cell, node: Node) -> Element:
    """Return a node that the spec names."""
    return element("node", _identity(cell, node), _parameters(cell, node))


def driver_node(cell: Cell, node: Node) -> Element:
    """Return a node of a device's driver; one for real hardware alone stays away from the mock."""
    condition = {"if": ON_REAL} if node.real_only else {}
    return element("node", _identity(cell, node) | condition, _parameters(cell, node))


def _identity(cell: Cell, node: Node) -> dict[str, str]:
    place = {"namespace": node.namespace} if node.namespace else {}
    again = {"respawn": "true"} if node.respawn else {}
    return {
        "pkg": node.package,
        "exec": node.executable,
        "name": node.name,
        **place,
        "output": "both",
        **again,
        **_enclave(enclave_of(cell, node)),
    }


def _enclave(path: str) -> dict[str, str]:
    # Without security it has no effect; with it, a process outside of its enclave is denied everything.
    return {"ros_args": f"--enclave {path}"}


def _parameters(cell: Cell, node: Node) -> Iterator[Element]:
    if is_planner(node) and cell.groups:
        yield _description_parameter(cell)
        semantic = f"$(command 'cat {share(cell, semantic_file(cell))}')"
        yield element("param", {"name": "robot_description_semantic", "value": semantic, "type": "str"})
        yield from (element("param", {"from": share(cell, file)}) for file in PARAMETER_FILES)
    if node.parameters:
        yield element("param", {"from": share(cell, node_file(node))})
    if node.source is NodeSource.SPEC and qos_parameters(cell, node):
        yield element("param", {"from": share(cell, QOS_OVERRIDES)})
    if node.clock == "sim":
        yield element("param", {"name": "use_sim_time", "value": "true"})


def _description_parameter(cell: Cell) -> Element:
    return element("param", {"name": "robot_description", "value": description(cell), "type": "str"})


def _remap(source: str, target: str) -> Element:
    return element("remap", {"from": source, "to": target})
