"""The rights of nodes: what every node needs, what the interfaces of the cell grant, and what the bring-up asks with.

The bring-up may see what it waits for, configure, observe and claim; it may never ask for motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.interface import InterfaceKind, Node, NodeSource
from cellc.contract.bring_up import TARGETS, BringUp, TopicProof
from cellc.deploy.processes import description_nodes
from cellc.formats.xml_text import element
from cellc.link.nodes import JOINT_STATES
from cellc.vocabulary import Feature, features

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
_TYPE_DESCRIPTION = "~/get_type_description"
_LOGGERS = ("~/get_logger_levels", "~/set_logger_levels")
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
_OF_SPAWNER = ("configure_controller", "list_controllers", "load_controller")  # what `spawner --inactive` calls
_CLEANUP = "cleanup_controller"
_CONTROLLER_STATE = "~/controller_state"
# What the program of the bring-up calls.
_OF_MANAGED = ("change_state", "get_state")
_OF_MANAGER = ("list_controllers", "list_hardware_components", "set_hardware_component_state", "switch_controller")


@dataclass(frozen=True, slots=True)
class Profile:
    """Rights of one node; names are absolute, or ``~/…`` below the node's own."""

    namespace: str
    node: str
    publish: tuple[str, ...] = ()
    subscribe: tuple[str, ...] = ()
    reply: tuple[str, ...] = ()
    request: tuple[str, ...] = ()
    execute: tuple[str, ...] = ()
    call: tuple[str, ...] = ()


def profile_element(profile: Profile) -> Element:
    """Return ``<profile>`` with one list a right; a name stands once in each, in alphabetical order."""
    return element("profile", {"ns": profile.namespace or "/", "node": profile.node}, _lists(profile))


def _lists(profile: Profile) -> Iterator[Element]:
    for plural, right, names in (
        ("topics", "publish", profile.publish),
        ("topics", "subscribe", profile.subscribe),
        ("services", "reply", profile.reply),
        ("services", "request", profile.request),
        ("actions", "execute", profile.execute),
        ("actions", "call", profile.call),
    ):
        if names:
            entries = (element(plural[:-1], text=name) for name in sorted(set(names)))
            yield element(plural, {right: "ALLOW"}, entries)


def node_profile(cell: Cell, node: Node) -> Profile:
    """Return the rights of a node with a process of its own."""
    granted = _granted(cell, node.full_name, _LIFECYCLE if node.lifecycle else ())
    return _driver(cell, node, granted) if node.source is NodeSource.DEVICE else _silenced(node, granted)


def _driver(cell: Cell, node: Node, granted: Profile) -> Profile:
    """Add what the catalog says that a driver's node offers: it fails where one of these is denied to it."""
    device = cell.device(node.device or "")

    def own(kind: InterfaceKind) -> tuple[str, ...]:
        names = (one.name for one in device.offers if one.kind is kind and one.node == node.full_name)
        return tuple(node.remaps.get(name, name) for name in names)

    def told(names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(node.remaps.get(name, name) for name in names)

    has = node.endpoints
    return replace(
        granted,
        publish=(*granted.publish, *own(InterfaceKind.TOPIC), *told(has.publishes)),
        subscribe=(*granted.subscribe, *told(has.subscribes)),
        reply=(*granted.reply, *own(InterfaceKind.SERVICE), *told(has.serves)),
        request=(*granted.request, *told(has.requests)),
        execute=(*granted.execute, *own(InterfaceKind.ACTION), *told(has.executes)),
    )


def _silenced(node: Node, granted: Profile) -> Profile:
    """Add the topics to which a node's transforms go unheard, and from which it hears no joint states."""
    said = (target for name, target in node.remaps.items() if name in ("/tf", "/tf_static"))
    heard = (target for name, target in node.remaps.items() if name not in ("/tf", "/tf_static"))
    return replace(granted, publish=(*granted.publish, *said), subscribe=(*granted.subscribe, *heard))


def _common_profile(cell: Cell) -> Profile:
    """Return the rights that every node has, for one that stands at no interface of the cell."""
    return _granted(cell, "/", ())


def manager_process(cell: Cell, manager: ControllerManager) -> Iterator[Profile]:
    """Yield the rights of the manager, its controllers and the nodes of its hardware."""
    services = (*_MANAGER, *((_CLEANUP,) if Feature.CLEANUP_CONTROLLER in features(cell.distro) else ()))
    yield _granted(cell, manager.node, tuple(f"{manager.node}/{one}" for one in services))
    for controller in manager.controllers:
        yield _controller(cell, controller)
    if Feature.HARDWARE_NODES in features(cell.distro):
        for device in (cell.device(name) for name in manager.devices):
            if device.hardware is not None:
                yield _granted(cell, f"{manager.namespace}/{device.hardware.name.lower()}", ())


def _controller(cell: Cell, controller: Controller) -> Profile:
    """Grant what the interfaces grant, and what the kind has besides: it fails where one of these is denied to it.

    Nobody is granted to publish what it subscribes to unless an interface of the cell says so.
    """
    loggers = _LOGGERS if Feature.LOGGER_SERVICES in features(cell.distro) else ()
    granted = _granted(cell, controller.full_name, loggers)
    kind = controller.declared
    topics = () if kind is None else tuple(one for one in kind.topics if not one.only or cell.distro in one.only)
    said = tuple(_own(controller, one.name) for one in topics if one.direction == "publish")
    heard = tuple(_own(controller, one.name) for one in topics if one.direction == "subscribe")
    served = () if kind is None else tuple(_own(controller, one.name) for one in kind.services)
    return replace(
        granted,
        publish=(*granted.publish, _CONTROLLER_STATE, *said),
        subscribe=(*granted.subscribe, *heard),
        reply=(*granted.reply, *served),
    )


def _own(controller: Controller, name: str) -> str:
    if name.startswith("~/"):
        return name
    return JOINT_STATES if name == "joint_states" else f"{controller.namespace}/{name}"


def manager_client(cell: Cell, manager: ControllerManager, node: str) -> Profile:
    """Return the rights of a spawner that loads and configures: it can activate nothing, and sets no parameters."""
    asked = tuple(f"{manager.node}/{service}" for service in _OF_SPAWNER)
    return replace(_granted(cell, f"{manager.namespace}/{node}", ()), request=asked)


def _granted(cell: Cell, full_name: str, services: tuple[str, ...]) -> Profile:
    def names(kind: InterfaceKind, side: str) -> tuple[str, ...]:
        return tuple(_names(cell, full_name, kind, side))

    namespace, _, name = full_name.rpartition("/")
    return Profile(
        namespace=namespace,
        node=name,
        publish=(*_PUBLISH, *names(InterfaceKind.TOPIC, "sources"), *_transitions(services)),
        subscribe=(*_SUBSCRIBE, *names(InterfaceKind.TOPIC, "sinks")),
        reply=(
            *_PARAMETERS,
            *((_TYPE_DESCRIPTION,) if Feature.TYPE_DESCRIPTION in features(cell.distro) else ()),
            *services,
            *names(InterfaceKind.SERVICE, "sources"),
        ),
        request=names(InterfaceKind.SERVICE, "sinks"),
        execute=names(InterfaceKind.ACTION, "sources"),
        call=names(InterfaceKind.ACTION, "sinks"),
    )


def _transitions(services: tuple[str, ...]) -> tuple[str, ...]:
    return ("~/transition_event",) if services == _LIFECYCLE else ()


def _names(cell: Cell, full_name: str, kind: InterfaceKind, side: str) -> Iterator[str]:
    """Yield the interfaces of one kind at whose side a node stands."""
    for interface in cell.interfaces:
        ends = interface.sources if side == "sources" else interface.sinks
        if interface.kind is kind and any(end.full_name == full_name for end in ends):
            yield interface.name


def bring_up_profile(cell: Cell, plan: BringUp) -> Profile:
    """Return the rights of the program that takes the steps of the bring-up."""
    common = _common_profile(cell)
    managed = (f"{node.full_name}/{one}" for node in cell.nodes if node.lifecycle for one in _OF_MANAGED)
    described = (f"{node}/get_parameters" for node in description_nodes(cell))
    managers = (f"{one.node}/{name}" for one in cell.managers for name in _OF_MANAGER)
    proofs = [proof for target in TARGETS for step in plan.steps(target) for proof in step.proof]
    watched = (one.while_holds for one in plan.watches)
    heard = (one.topic for one in (*proofs, *watched) if isinstance(one, TopicProof))
    return Profile(
        namespace="",
        node="bring_up",
        publish=common.publish,
        subscribe=(*common.subscribe, *heard, "/tf", "/tf_static"),
        reply=common.reply,
        request=(*managed, *managers, *described),
    )
