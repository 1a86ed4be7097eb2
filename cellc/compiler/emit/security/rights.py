"""The rights of nodes: what every node needs, what the interfaces of the cell grant, and what the bring-up asks with.

The bring-up may see what it waits for, configure, observe and claim; it may never ask for motion.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from enum import Enum
from itertools import chain
from typing import NamedTuple

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import InnerNode, Node, NodeEndpoints, NodeSource
from cellc.compiler.deploy.files import plans
from cellc.compiler.deploy.observation import nodes_on, readings
from cellc.compiler.deploy.processes import bring_up_nodes, description_nodes, motion_clients
from cellc.compiler.deploy.recording import recorded_topics, reporting
from cellc.contract.bring_up import CLAIM_WATCH, BringUp, TopicProof
from cellc.contract.entities import TARGETS
from cellc.contract.frozen import dataclass
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
_RECORDER = "rosbag2_recorder"
_TYPED = ("_ros2cli_*", "tf2_echo", "tf2_monitor*", _RECORDER, "transform_listener_impl_*")
# RViz's node and, of MoveIt's displays, those of the scene monitor and of who waits for a description; rviz 14.3,
# rviz_common/src/rviz_common/visualizer_app.cpp:151; moveit2 2.14.3, planning_scene_monitor.cpp:116 and
# synchronized_string_parameter.cpp:123.
_RVIZ = ("rviz", "rviz_private_*", "rviz_ssp_*")
_OF_RECORDER = ("is_paused", "pause", "record", "resume", "snapshot", "split_bagfile", "stop")


class Rights(NamedTuple):
    """Names that may be used, by right: absolute, ``~/…`` below a node's own, or else below its namespace."""

    publish: tuple[str, ...] = ()
    subscribe: tuple[str, ...] = ()
    reply: tuple[str, ...] = ()
    request: tuple[str, ...] = ()
    execute: tuple[str, ...] = ()
    call: tuple[str, ...] = ()


class Kind(str, Enum):
    """What gives several nodes the same rights."""

    NODE = "node"
    NODE_WITHOUT_PARAMETERS = "node_without_parameters"
    LIFECYCLE_NODE = "lifecycle_node"
    TRANSFORM_LISTENER = "transform_listener"
    CONTROLLER = "controller"
    HARDWARE_COMPONENT = "hardware_component"
    BRING_UP = "bring_up"
    OBSERVER = "observer"
    PEOPLE = "people"
    RECORDER = "recorder"
    RVIZ = "rviz"
    COMMISSIONING = "commissioning"


@dataclass(frozen=True, slots=True)
class Profile:
    """The rights of one node: those of its kinds, and its own beside them."""

    full_name: str
    kinds: tuple[Kind, ...]
    own: Rights

    def all_rights(self, shared: Mapping[Kind, Rights]) -> Rights:
        """Return its own rights with those of its kinds."""
        return _together(self.own, *(shared[kind] for kind in self.kinds))


def rights_of_kinds(cell: Cell, plan: BringUp) -> dict[Kind, Rights]:
    """Return the rights that each kind gives."""
    node, looking = _rights(cell.implied.node), _of_observer(cell)
    moving = tuple(f"{node.full_name}/change_state" for node in motion_clients(cell) if node.lifecycle)
    return {
        Kind.NODE: node,
        Kind.NODE_WITHOUT_PARAMETERS: node._replace(reply=()),
        Kind.LIFECYCLE_NODE: _rights(cell.implied.lifecycle),
        Kind.TRANSFORM_LISTENER: _rights(cell.implied.transforms),
        Kind.CONTROLLER: _rights(cell.implied.controller)._replace(
            publish=(*cell.implied.controller.publishes, _CONTROLLER_STATE)
        ),
        Kind.HARDWARE_COMPONENT: _rights(cell.implied.component),
        Kind.BRING_UP: _of_bring_up(cell, plan),
        Kind.OBSERVER: looking,
        Kind.PEOPLE: Rights(request=moving),
        Kind.RECORDER: _of_recorder(cell, looking),
        Kind.RVIZ: _of_rviz(cell),
        Kind.COMMISSIONING: _of_commissioning(cell),
    }


def _together(*several: Rights) -> Rights:
    return Rights(*(tuple(chain.from_iterable(names)) for names in zip(*several, strict=True)))


def _rights(own: NodeEndpoints) -> Rights:
    return Rights(own.publishes, own.subscribes, own.serves, own.requests, own.executes)


def node_profiles(cell: Cell, node: Node) -> Iterator[Profile]:
    """Yield the rights of a node with a process of its own, and of the further nodes in it."""
    offered = _offered(cell, node) if node.source is NodeSource.DEVICE else _unheard(node)
    profile = _profile(cell, node.full_name, Kind.NODE, own=_together(_renamed(node), offered))
    kinds = ((Kind.LIFECYCLE_NODE, node.lifecycle), (Kind.TRANSFORM_LISTENER, _hears_transforms(node, profile.own)))
    yield replace(profile, kinds=(*profile.kinds, *(kind for kind, given in kinds if given)))
    yield from (_inner(cell, item.full_name, item) for item in node.inside)


_NONE = Rights()


def _profile(cell: Cell, full_name: str, *kinds: Kind, own: Rights = _NONE) -> Profile:
    """Return the rights of a node: by its kinds, by the interfaces of the cell that it is at, and others of its own."""
    return Profile(full_name, kinds, _together(_at_interfaces(cell, full_name), own))


def _offered(cell: Cell, node: Node) -> Rights:
    """Return what the catalog says that a driver's node offers: it fails where one of these is denied to it."""
    device = cell.device(node.device or "")

    def own(kind: InterfaceKind) -> tuple[str, ...]:
        return tuple(
            offer.name for offer in device.control.offers if offer.kind is kind and offer.node == node.full_name
        )

    return Rights(publish=own(InterfaceKind.TOPIC), reply=own(InterfaceKind.SERVICE), execute=own(InterfaceKind.ACTION))


def _renamed(node: Node) -> Rights:
    """Return the endpoints of a program under the names that they have in the cell."""
    return Rights(*(tuple(node.remaps.get(name, name) for name in names) for names in _rights(node.endpoints)))


def _hears_transforms(node: Node, own: Rights) -> bool:
    # A buffer of tf2 in a node of the cell serves what it holds; a program that the catalog knows says so itself.
    return node.source is NodeSource.SPEC and not node.inside and "/tf" in own.subscribe


def _unheard(node: Node) -> Rights:
    """Return the topics to which a node's transforms go unheard, and from which it hears no joint states."""
    transforms = ("/tf", "/tf_static")
    return Rights(
        publish=tuple(target for name, target in node.remaps.items() if name in transforms),
        subscribe=tuple(target for name, target in node.remaps.items() if name not in transforms),
    )


def _inner(cell: Cell, full_name: str, inner: InnerNode) -> Profile:
    kind = Kind.NODE if inner.parameters else Kind.NODE_WITHOUT_PARAMETERS
    return _profile(cell, full_name, kind, own=_rights(inner.endpoints))


def manager_process(cell: Cell, manager: ControllerManager) -> Iterator[Profile]:
    """Yield the rights of the manager, its controllers and the nodes of its hardware."""
    (node,) = (node for node in cell.nodes if node.full_name == manager.node)
    yield _profile(cell, manager.node, Kind.NODE, own=_renamed(node))
    yield from (_inner(cell, item.full_name, item) for item in node.inside)
    for controller in manager.controllers:
        yield _controller(cell, controller)
    for device in (cell.device(name) for name in manager.devices):
        if device.control.hardware is None:
            continue
        if Feature.HARDWARE_NODES in features(cell.distro):
            name = device.control.hardware.name.lower().replace("/", "_")
            yield _profile(cell, f"{manager.namespace}/{name}", Kind.NODE, Kind.HARDWARE_COMPONENT)
        for item in device.control.hardware.nodes:
            # The namespace of the process is that of every node in it.
            bare = item.full_name.rpartition("/")[2]
            yield _inner(cell, f"{manager.namespace}/{bare}" if manager.namespace else item.full_name, item)


def _controller(cell: Cell, controller: Controller) -> Profile:
    """Grant the rights of the interfaces, and those that the kind of node needs in order to run.

    A subscriber gets no right to publish on the same topic unless an interface of the cell says so.
    """
    kind, below = controller.declared, f"{controller.full_name}/"

    def own(*, publishes: bool) -> tuple[str, ...]:
        names = (topic.name for topic in controller.own_topics if topic.publishes == publishes)
        return tuple(f"~/{name.removeprefix(below)}" if name.startswith(below) else name for name in names)

    declared = Rights(
        publish=own(publishes=True),
        subscribe=own(publishes=False),
        reply=() if kind is None else tuple(service.name for service in kind.services),
    )
    return _profile(cell, controller.full_name, Kind.NODE, Kind.CONTROLLER, own=declared)


def manager_client(cell: Cell, manager: ControllerManager, node: str) -> Profile:
    """Return the rights of a spawner that loads and configures: it can activate nothing, and sets no parameters."""
    asked = tuple(f"{manager.node}/{service}" for service in _OF_SPAWNER)
    return _profile(cell, f"{manager.namespace}/{node}", Kind.NODE, own=Rights(request=asked))


def _at_interfaces(cell: Cell, full_name: str) -> Rights:
    """Return what a node has by the interfaces at which it is."""

    def names(kind: InterfaceKind, *, serves: bool) -> tuple[str, ...]:
        ends = cell.ends_of.get(full_name, ())
        found = (end.interface.name for end in ends if end.interface.kind is kind and end.serves == serves)
        return tuple(dict.fromkeys(found))

    return Rights(
        publish=names(InterfaceKind.TOPIC, serves=True),
        subscribe=names(InterfaceKind.TOPIC, serves=False),
        reply=names(InterfaceKind.SERVICE, serves=True),
        request=names(InterfaceKind.SERVICE, serves=False),
        execute=names(InterfaceKind.ACTION, serves=True),
        call=names(InterfaceKind.ACTION, serves=False),
    )


def bring_up_process(cell: Cell, plan: BringUp) -> Iterator[Profile]:
    """Yield the rights of the program that takes the steps of the bring-up, under each name that it gives its node."""
    for node in bring_up_nodes(plan):
        yield _profile(cell, f"/{node}", Kind.NODE, Kind.BRING_UP)
    if plan.watches:
        yield _profile(cell, CLAIM_WATCH, Kind.NODE, own=_of_watch(plan))


def _of_bring_up(cell: Cell, plan: BringUp) -> Rights:
    managed = (f"{node.full_name}/{text}" for node in cell.nodes if node.lifecycle for text in _OF_MANAGED)
    described = (f"{node}/get_parameters" for node in description_nodes(cell))
    managers = (f"{manager.node}/{name}" for manager in cell.managers for name in _OF_MANAGER)
    stepped = [proof for target in TARGETS for step in plan.steps(target) for proof in step.proof]
    shared = [proof for target in TARGETS for proofs in plan.shared[target].values() for proof in proofs]
    heard = (proof.topic for proof in (*stepped, *shared) if isinstance(proof, TopicProof))
    acknowledged = (watch.acknowledge for watch in plan.watches)
    asked = (*managed, *managers, *described, *acknowledged)
    return Rights(subscribe=(*heard, "/tf", "/tf_static"), request=asked)


def _of_watch(plan: BringUp) -> Rights:
    """Return what ends goals, claims and motion clients has: it can cancel and deactivate, and send no goal."""
    watches = plan.watches
    return Rights(
        subscribe=tuple(proof.topic for watch in watches for proof in watch.while_hold.values()),
        reply=tuple(watch.acknowledge for watch in watches),
        request=(
            *(f"{watch.manager}/{name}" for watch in watches for name in ("list_controllers", "switch_controller")),
            *(f"{action}/_action/cancel_goal" for watch in watches for action in watch.actions),
            *(f"{node}/change_state" for watch in watches for node in watch.nodes),
        ),
    )


def sender(cell: Cell, node: str, action: str, states: str) -> Profile:
    """Return the rights of what sends one goal that a person releases."""
    return _profile(cell, node, Kind.NODE, own=Rights(subscribe=(states,), call=(action,)))


def people(cell: Cell, *more: Kind) -> Iterator[Profile]:
    """Yield the rights of manual commands, under each name that these programs give their nodes.

    Args:
        more: kinds besides, such as that of the command with which a person acts.
    """
    for name in _TYPED:
        recorder = (Kind.RECORDER,) if name == _RECORDER else ()
        yield _profile(cell, f"/{name}", Kind.NODE, Kind.OBSERVER, Kind.PEOPLE, *recorder, *more)
    for name in _RVIZ if plans(cell) else _RVIZ[:1]:
        yield _profile(cell, f"/{name}", Kind.NODE, Kind.OBSERVER, Kind.PEOPLE, Kind.RVIZ, *more)


def observer(cell: Cell, plan: BringUp) -> Profile:
    """Return the rights of the program that compares the graph with the package.

    Beside what people may look at, it asks for parameters, hears what cycles take, and asks devices for their versions.
    """
    running = {name for target in TARGETS for name, _ in nodes_on(cell, plan, target) if "*" not in name}
    asked = (f"{name}/get_parameters" for name in sorted(running))
    names = {interface.name: interface.kind for interface in cell.interfaces}
    queried = (reading.interface for reading in readings(cell) if names[reading.interface] is InterfaceKind.SERVICE)
    cycles = (f"{node}/statistics/{part}" for node in reporting(cell) for part in ("names", "values"))
    diagnoses = ("/diagnostics",) if reporting(cell) else ()
    own = Rights(subscribe=(*cycles, *diagnoses), request=(*asked, *queried))
    return Profile("/observe", (Kind.NODE_WITHOUT_PARAMETERS, Kind.OBSERVER), own)


def _of_observer(cell: Cell) -> Rights:
    """Return the rights to read everything: without any to publish, call an action or switch a controller."""
    topics = (interface.name for interface in cell.interfaces if interface.kind is InterfaceKind.TOPIC)
    actions = (interface.name for interface in cell.interfaces if interface.kind is InterfaceKind.ACTION)
    hidden = (f"{name}/_action/{part}" for name in actions for part in ("feedback", "status"))
    managers = (f"{manager.node}/{name}" for manager in cell.managers for name in _LISTED)
    managed = (f"{node.full_name}/{text}" for node in cell.nodes if node.lifecycle for text in _LOOKED_AT)
    described = (f"{node}/get_parameters" for node in description_nodes(cell))
    return Rights(
        subscribe=(*topics, *hidden, "/rosout", "/tf", "/tf_static"), request=(*managers, *managed, *described)
    )


def _of_recorder(cell: Cell, looking: Rights) -> Rights:
    """Return what the recorder has beside the rights to look."""
    return Rights(
        publish=("/events/write_split",),
        subscribe=tuple(topic for topic in recorded_topics(cell) if topic not in looking.subscribe),
        reply=tuple(f"~/{text}" for text in _OF_RECORDER),
    )


def _of_rviz(cell: Cell) -> Rights:
    """Return what RViz has for the displays of ``config/cell.rviz``, and its service that begins its views again."""
    place = next((node.namespace for node in cell.planners), "")
    planned = ("monitored_planning_scene", "display_planned_path", "robot_description_semantic")
    return Rights(
        subscribe=("/robot_description", *(f"{place}/{text}" for text in planned if plans(cell))),
        request=(f"{place}/get_planning_scene",) if plans(cell) else (),
        reply=("~/reset_time",),
    )


def _of_commissioning(cell: Cell) -> Rights:
    """Return the rights with which a person acts: to end motion and release claims.

    And to call what a vendor's procedure names. A goal is sent by none of it but where that procedure says so.
    """
    actions = (
        interface.name
        for interface in cell.interfaces
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets
    )
    managers = (f"{manager.node}/{name}" for manager in cell.managers for name in _ACTED_ON)
    named = [procedure for device in cell.devices for procedure in _in_procedures(cell, device)]
    return Rights(
        request=(
            *(f"{name}/_action/cancel_goal" for name in actions),
            *managers,
            *(name for kind, name in named if kind is InterfaceKind.SERVICE),
        ),
        call=tuple(name for kind, name in named if kind is InterfaceKind.ACTION),
    )


def _in_procedures(cell: Cell, device: Device) -> Iterator[tuple[InterfaceKind, str]]:
    """Yield what nodes of a device serve that its vendor has people call: ``call NAME``, ``NAME of NODE``."""
    steps = (step for procedure in device.procedures.safety.recovery for step in procedure.steps)
    text = " ".join((*steps, *(step.does for step in device.procedures.commissioning)))
    for kind, name in dict.fromkeys(_served(cell, device)):
        node, _, last = name.rpartition("/")
        if last not in text:
            continue
        of = re.escape(node.rpartition("/")[2])
        if re.search(rf"\b(?:action|[Cc]alls?) (?:{re.escape(name)}|{last})\b|\b{last} of (?:the )?{of}\b", text):
            yield kind, name


def _served(cell: Cell, device: Device) -> Iterator[tuple[InterfaceKind, str]]:
    yield from ((offer.kind, offer.name) for offer in device.control.offers if offer.kind is not InterfaceKind.TOPIC)
    nodes = [(node.full_name, node.endpoints) for node in cell.nodes_of.get(device.name, ())]
    if device.control.hardware is not None:
        nodes += [(node.full_name, node.endpoints) for node in device.control.hardware.nodes]
    for node, endpoints in nodes:
        yield from ((InterfaceKind.SERVICE, name.replace("~", node, 1)) for name in endpoints.serves)
        yield from ((InterfaceKind.ACTION, name.replace("~", node, 1)) for name in endpoints.executes)
