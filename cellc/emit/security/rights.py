"""The rights of nodes: what every node needs, and what the interfaces of the cell grant."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.cell.interface import InterfaceKind, Node
from cellc.emit.security.profile import Profile
from cellc.emit.security.several_managers import description_topic, merged, of_namesake

_PUBLISH = ("/parameter_events", "/rosout")
_SUBSCRIBE = ("/clock", "/parameter_events")
_PARAMETERS = (
    "~/describe_parameters",
    "~/get_parameter_types",
    "~/get_parameters",
    "~/list_parameters",
    "~/set_parameters",
    "~/set_parameters_atomically",
)
_TYPE_DESCRIPTION = "~/get_type_description"  # Iron and later
_LOGGERS = ("~/get_logger_levels", "~/set_logger_levels")  # controllers of Jazzy and later
_LIFECYCLE = (
    "~/change_state",
    "~/get_available_states",
    "~/get_available_transitions",
    "~/get_state",
    "~/get_transition_graph",
)
_MANAGER = (
    "configure_controller",
    "list_controller_types",
    "list_controllers",
    "list_hardware_components",
    "list_hardware_interfaces",
    "load_controller",
    "reload_controller_libraries",
    "set_hardware_component_state",
    "switch_controller",
    "unload_controller",
)
_CLEANUP = "cleanup_controller"  # Jazzy and later
_CONTROLLER_STATE = "~/controller_state"


def node_profile(cell: Cell, node: Node) -> Profile:
    """Return the rights of a node with a process of its own."""
    return _granted(cell, node.namespace, node.name, _LIFECYCLE if node.lifecycle else ())


def common_profile(cell: Cell) -> Profile:
    """Return the rights that every node has, for one that stands at no interface of the cell."""
    return _granted(cell, "", "", ())


def manager_process(cell: Cell, manager: ControllerManager) -> Iterator[Profile]:
    """Yield the rights of the manager, its controllers and, from Jazzy on, the nodes of its hardware."""
    name = f"{manager.namespace}/controller_manager"
    services = (*_MANAGER, *(() if cell.distro == "humble" else (_CLEANUP,)))
    granted = _granted(cell, manager.namespace, "controller_manager", tuple(f"{name}/{one}" for one in services))
    yield replace(granted, subscribe=(*_SUBSCRIBE, description_topic(cell, manager)))
    for controller in manager.controllers:
        yield _granted(cell, manager.namespace, controller.name, () if cell.distro == "humble" else _LOGGERS)
    if cell.distro != "humble":
        for device in (cell.device(name) for name in manager.devices):
            if device.hardware is not None:
                yield _granted(cell, manager.namespace, device.hardware.name.lower(), ())


def manager_client(manager: ControllerManager, node: str) -> Profile:
    """Return the rights of a spawner: to ask the manager and to set the parameters of what it loads."""
    name = f"{manager.namespace}/controller_manager"
    asked = (*(f"{name}/{service}" for service in (*_MANAGER, _CLEANUP)), f"{name}/set_parameters")
    return Profile(
        namespace=manager.namespace,
        node=node,
        publish=_PUBLISH,
        subscribe=_SUBSCRIBE,
        reply=_PARAMETERS,
        request=(*asked, f"{name}/get_parameters", f"{name}/describe_parameters", f"{name}/list_parameters"),
    )


def _granted(cell: Cell, namespace: str, name: str, services: tuple[str, ...]) -> Profile:
    def names(kind: InterfaceKind, side: str) -> tuple[str, ...]:
        return tuple(found for found in _names(cell, name, kind, side) if not of_namesake(cell, namespace, name, found))

    managed = {controller.name for controller in cell.controllers}
    publish = (*_PUBLISH, *((_CONTROLLER_STATE,) if name in managed else ()))
    return Profile(
        namespace=namespace,
        node=name,
        publish=(*publish, *names(InterfaceKind.TOPIC, "sources"), *_transitions(services)),
        subscribe=(*_SUBSCRIBE, *merged(cell, names(InterfaceKind.TOPIC, "sinks"))),
        reply=(
            *_PARAMETERS,
            *(() if cell.distro == "humble" else (_TYPE_DESCRIPTION,)),
            *services,
            *names(InterfaceKind.SERVICE, "sources"),
        ),
        request=names(InterfaceKind.SERVICE, "sinks"),
        execute=names(InterfaceKind.ACTION, "sources"),
        call=names(InterfaceKind.ACTION, "sinks"),
    )


def _transitions(services: tuple[str, ...]) -> tuple[str, ...]:
    return ("~/transition_event",) if services == _LIFECYCLE else ()


def _names(cell: Cell, node: str, kind: InterfaceKind, side: str) -> Iterator[str]:
    """Yield the interfaces of one kind at whose side a node stands."""
    for interface in cell.interfaces:
        ends = interface.sources if side == "sources" else interface.sinks
        if interface.kind is kind and any(end.node == node for end in ends):
            yield interface.name
