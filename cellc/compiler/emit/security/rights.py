"""The rights of nodes: what every node needs, what the interfaces of the cell grant, and what the bring-up asks with.

The bring-up may see what it waits for, configure, observe and claim; it may never ask for motion.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import reduce
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import InnerNode, Node, NodeEndpoints, NodeSource
from cellc.compiler.deploy.files import plans
from cellc.compiler.deploy.processes import bring_up_nodes, description_nodes, motion_clients
from cellc.compiler.deploy.recording import recorded_topics
from cellc.compiler.formats.xml_text import element
from cellc.compiler.link.hardware import JOINT_STATES
from cellc.contract.bring_up import BringUp, TopicProof
from cellc.contract.entities import TARGETS
from cellc.contract.vocabulary import Feature, InterfaceKind, features

_OF_SPAWNER = ("configure_controller", "list_controllers", "load_controller")  # what `spawner --inactive` calls
_CONTROLLER_STATE = "~/controller_state"
# What the program of the bring-up calls.
_OF_MANAGED = ("change_state", "get_state")
_OF_MANAGER = ("list_controllers", "list_hardware_components", "set_hardware_component_state", "switch_controller")
# What the commands of the gates call: `ros2 control list_*`, `ros2 lifecycle get` and `set`, `get_parameters`.
_LISTED = ("list_controllers", "list_hardware_components", "list_hardware_interfaces")
# What recoveries and the way back call: `ros2 control switch_controllers` and `set_hardware_component_state`.
_ACTED_ON = ("set_hardware_component_state", "switch_controller")
_LOOKED_AT = ("get_available_transitions", "get_state")
# The names that they give their nodes: ros2cli (and its daemon), tf2_ros, rosbag2_transport.
_TYPED = ("_ros2cli_*", "tf2_echo", "tf2_monitor*", "rosbag2_recorder", "transform_listener_impl_*")
# RViz's node and, of MoveIt's displays, those of the scene monitor and of who waits for a description; rviz 14.3,
# rviz_common/src/rviz_common/visualizer_app.cpp:151; moveit2 2.14.3, planning_scene_monitor.cpp:116 and
# synchronized_string_parameter.cpp:123.
_RVIZ = ("rviz", "rviz_private_*", "rviz_ssp_*")
_OF_RECORDER = ("is_paused", "pause", "record", "resume", "snapshot", "split_bagfile", "stop")


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
    """Return ``<profile>`` with one list a right; a name is once in each, in alphabetical order."""
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


def node_profiles(cell: Cell, node: Node) -> Iterator[Profile]:
    """Yield the rights of a node with a process of its own, and of the further nodes in it."""
    implied = cell.implied
    kinds = (implied.lifecycle,) if node.lifecycle else ()
    granted = _with(_granted(cell, node.full_name, *kinds), _renamed(node, node.endpoints))
    if node.source is NodeSource.DEVICE:
        yield _with(granted, _offered(cell, node))
    else:
        granted = _silenced(node, granted)
        yield _with(granted, implied.transforms) if _hears_transforms(node, granted) else granted
    yield from (_inner(cell, item.full_name, item) for item in node.inside)


def _offered(cell: Cell, node: Node) -> NodeEndpoints:
    """Return what the catalog says that a driver's node offers: it fails where one of these is denied to it."""
    device = cell.device(node.device or "")

    def own(kind: InterfaceKind) -> tuple[str, ...]:
        return tuple(offer.name for offer in device.offers if offer.kind is kind and offer.node == node.full_name)

    return NodeEndpoints(
        publishes=own(InterfaceKind.TOPIC), serves=own(InterfaceKind.SERVICE), executes=own(InterfaceKind.ACTION)
    )


def _renamed(node: Node, own: NodeEndpoints) -> NodeEndpoints:
    """Return endpoints under the names that they have in the cell."""

    def remapped(names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(node.remaps.get(name, name) for name in names)

    return NodeEndpoints(**{field.name: remapped(getattr(own, field.name)) for field in fields(NodeEndpoints)})


def _with(granted: Profile, own: NodeEndpoints) -> Profile:
    return replace(
        granted,
        publish=(*granted.publish, *own.publishes),
        subscribe=(*granted.subscribe, *own.subscribes),
        reply=(*granted.reply, *own.serves),
        request=(*granted.request, *own.requests),
        execute=(*granted.execute, *own.executes),
    )


def _hears_transforms(node: Node, granted: Profile) -> bool:
    # A buffer of tf2 in a node of the cell serves what it holds; a program that the catalog knows says so itself.
    return node.source is NodeSource.SPEC and not node.inside and "/tf" in granted.subscribe


def _silenced(node: Node, granted: Profile) -> Profile:
    """Add the topics to which a node's transforms go unheard, and from which it hears no joint states."""
    said = (target for name, target in node.remaps.items() if name in ("/tf", "/tf_static"))
    heard = (target for name, target in node.remaps.items() if name not in ("/tf", "/tf_static"))
    return replace(granted, publish=(*granted.publish, *said), subscribe=(*granted.subscribe, *heard))


def _inner(cell: Cell, full_name: str, one: InnerNode) -> Profile:
    granted = _with(_granted(cell, full_name), one.endpoints)
    return granted if one.parameters else replace(granted, reply=one.endpoints.serves)


def manager_process(cell: Cell, manager: ControllerManager) -> Iterator[Profile]:
    """Yield the rights of the manager, its controllers and the nodes of its hardware."""
    (node,) = (node for node in cell.nodes if node.full_name == manager.node)
    yield _with(_granted(cell, manager.node), _renamed(node, node.endpoints))
    yield from (_inner(cell, item.full_name, item) for item in node.inside)
    for controller in manager.controllers:
        yield _controller(cell, controller)
    for device in (cell.device(name) for name in manager.devices):
        if device.hardware is None:
            continue
        if Feature.HARDWARE_NODES in features(cell.distro):
            name = device.hardware.name.lower().replace("/", "_")
            yield _granted(cell, f"{manager.namespace}/{name}", cell.implied.component)
        for item in device.hardware.nodes:
            # The namespace of the process is that of every node in it.
            bare = item.full_name.rpartition("/")[2]
            yield _inner(cell, f"{manager.namespace}/{bare}" if manager.namespace else item.full_name, item)


def _controller(cell: Cell, controller: Controller) -> Profile:
    """Grant the rights of the interfaces, and those that the kind of node needs in order to run.

    A subscriber gets no right to publish on the same topic unless an interface of the cell says so.
    """
    granted = _granted(cell, controller.full_name, cell.implied.controller)
    kind = controller.declared
    topics = (
        () if kind is None else tuple(topic for topic in kind.topics if not topic.only or cell.distro in topic.only)
    )
    said = tuple(_own(controller, topic.name) for topic in topics if topic.direction == "publish")
    heard = tuple(_own(controller, topic.name) for topic in topics if topic.direction == "subscribe")
    served = () if kind is None else tuple(_own(controller, service.name) for service in kind.services)
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
    return replace(_granted(cell, f"{manager.namespace}/{node}"), request=asked)


def _granted(cell: Cell, full_name: str, *kinds: NodeEndpoints) -> Profile:
    """Return what a node has by what it is, and by the interfaces at which it is."""

    def names(kind: InterfaceKind, side: str) -> tuple[str, ...]:
        return tuple(_names(cell, full_name, kind, side))

    namespace, _, name = full_name.rpartition("/")
    granted = Profile(
        namespace=namespace,
        node=name,
        publish=names(InterfaceKind.TOPIC, "sources"),
        subscribe=names(InterfaceKind.TOPIC, "sinks"),
        reply=names(InterfaceKind.SERVICE, "sources"),
        request=names(InterfaceKind.SERVICE, "sinks"),
        execute=names(InterfaceKind.ACTION, "sources"),
        call=names(InterfaceKind.ACTION, "sinks"),
    )
    return reduce(_with, (cell.implied.node, *kinds), granted)


def _names(cell: Cell, full_name: str, kind: InterfaceKind, side: str) -> Iterator[str]:
    """Yield the interfaces of one kind at whose side a node is."""
    serves = side == "sources"
    ends = cell.ends_of.get(full_name, ())
    yield from dict.fromkeys(end.interface.name for end in ends if end.interface.kind is kind and end.serves == serves)


def bring_up_process(cell: Cell, plan: BringUp) -> Iterator[Profile]:
    """Yield the rights of the program that takes the steps of the bring-up, under each name that it gives its node."""
    managed = (f"{node.full_name}/{text}" for node in cell.nodes if node.lifecycle for text in _OF_MANAGED)
    described = (f"{node}/get_parameters" for node in description_nodes(cell))
    managers = (f"{manager.node}/{name}" for manager in cell.managers for name in _OF_MANAGER)
    proofs = [proof for target in TARGETS for step in plan.steps(target) for proof in step.proof]
    watched = (watch.while_holds for watch in plan.watches)
    heard = (proof.topic for proof in (*proofs, *watched) if isinstance(proof, TopicProof))
    asks = NodeEndpoints(subscribes=(*heard, "/tf", "/tf_static"), requests=(*managed, *managers, *described))
    for node in bring_up_nodes(plan):
        yield _with(_granted(cell, f"/{node}"), asks)


def sender(cell: Cell, node: str, action: str, states: str) -> Profile:
    """Return the rights of what sends one goal that a person releases."""
    return replace(_with(_granted(cell, node), NodeEndpoints(subscribes=(states,))), call=(action,))


def people(cell: Cell) -> Iterator[Profile]:
    """Yield the rights of manual commands: to read everything, and to activate the managed nodes that move.

    A shell may not publish, call an action or switch a controller.
    """
    topics = (interface.name for interface in cell.interfaces if interface.kind is InterfaceKind.TOPIC)
    actions = (interface.name for interface in cell.interfaces if interface.kind is InterfaceKind.ACTION)
    hidden = (f"{name}/_action/{part}" for name in actions for part in ("feedback", "status"))
    managers = (f"{manager.node}/{name}" for manager in cell.managers for name in _LISTED)
    managed = (f"{node.full_name}/{text}" for node in cell.nodes if node.lifecycle for text in _LOOKED_AT)
    moving = (f"{node.full_name}/change_state" for node in motion_clients(cell) if node.lifecycle)
    described = (f"{node}/get_parameters" for node in description_nodes(cell))
    asks = NodeEndpoints(
        subscribes=(*topics, *hidden, "/rosout", "/tf", "/tf_static"),
        requests=(*managers, *managed, *moving, *described),
    )
    recorder = NodeEndpoints(
        publishes=("/events/write_split",),
        subscribes=tuple(recorded_topics(cell)),
        serves=tuple(f"~/{text}" for text in _OF_RECORDER),
    )
    for name in _TYPED:
        profile = _granted(cell, f"/{name}")
        yield _with(_with(profile, asks), recorder) if name == "rosbag2_recorder" else _with(profile, asks)
    for name in _RVIZ if plans(cell) else _RVIZ[:1]:
        yield _with(_with(_granted(cell, f"/{name}"), asks), _shown(cell))


def _shown(cell: Cell) -> NodeEndpoints:
    """Return what RViz has for the displays of ``config/cell.rviz``, and its service that begins its views again."""
    place = next((node.namespace for node in cell.planners), "")
    planned = ("monitored_planning_scene", "display_planned_path", "robot_description_semantic")
    return NodeEndpoints(
        subscribes=("/robot_description", *(f"{place}/{text}" for text in planned if plans(cell))),
        requests=(f"{place}/get_planning_scene",) if plans(cell) else (),
        serves=("~/reset_time",),
    )


def commissioning(cell: Cell) -> Iterator[Profile]:
    """Yield the rights of the command with which a person acts: to end motion and release claims, beside looking.

    And to call what a vendor's procedure names. A goal is sent by none of it but where that procedure says so.
    """
    actions = (
        interface.name
        for interface in cell.interfaces
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets
    )
    managers = tuple(f"{manager.node}/{name}" for manager in cell.managers for name in _ACTED_ON)
    named = [procedure for device in cell.devices for procedure in _in_procedures(cell, device)]
    requests = (
        *(f"{name}/_action/cancel_goal" for name in actions),
        *managers,
        *(name for kind, name in named if kind is InterfaceKind.SERVICE),
    )
    calls = tuple(name for kind, name in named if kind is InterfaceKind.ACTION)
    for profile in people(cell):
        yield replace(profile, request=(*profile.request, *requests), call=(*profile.call, *calls))


def _in_procedures(cell: Cell, device: Device) -> Iterator[tuple[InterfaceKind, str]]:
    """Yield what nodes of a device serve that its vendor has people call: ``call NAME``, ``NAME of NODE``."""
    steps = (step for procedure in device.safety.recovery for step in procedure.steps)
    text = " ".join((*steps, *(step.does for step in device.commissioning)))
    for kind, name in dict.fromkeys(_served(cell, device)):
        node, _, last = name.rpartition("/")
        if last not in text:
            continue
        of = re.escape(node.rpartition("/")[2])
        if re.search(rf"\b(?:action|[Cc]alls?) (?:{re.escape(name)}|{last})\b|\b{last} of (?:the )?{of}\b", text):
            yield kind, name


def _served(cell: Cell, device: Device) -> Iterator[tuple[InterfaceKind, str]]:
    yield from ((offer.kind, offer.name) for offer in device.offers if offer.kind is not InterfaceKind.TOPIC)
    nodes = [(node.full_name, node.endpoints) for node in cell.nodes_of.get(device.name, ())]
    if device.hardware is not None:
        nodes += [(node.full_name, node.endpoints) for node in device.hardware.nodes]
    for node, endpoints in nodes:
        yield from ((InterfaceKind.SERVICE, name.replace("~", node, 1)) for name in endpoints.serves)
        yield from ((InterfaceKind.ACTION, name.replace("~", node, 1)) for name in endpoints.executes)
