"""Interfaces that follow from devices and controllers; the user need not write them, and may.

TF and the description first, then the joint states of the cell, then what controllers execute, publish and serve.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property

from cellc.compiler.catalog.controller_kind import ControllerService
from cellc.compiler.cell.control import Controller, ControllerManager, ControllerTopic
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Frame, FrameKind
from cellc.compiler.cell.interface import Endpoint, Interface, Node, NodeSource
from cellc.compiler.cell.motion import Servo
from cellc.compiler.link.endpoints import EndName, EndpointNames
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.compiler.link.names import JOINT_STATES, graph_name
from cellc.compiler.link.nodes import DESCRIPTION, DESCRIPTION_PUBLISHER, description_home
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import OF_ONE_DEVICE, TRAJECTORIES, UNKNOWN, InterfaceKind


# Without slots, so that what is asked for each controller is looked up once and kept.
@dataclass(frozen=True)
class Derivation:
    """The linked parts of a cell that bring interfaces along."""

    spec: CellSpec
    document: SourceDocument
    managers: tuple[ControllerManager, ...]
    devices: tuple[Device, ...]
    frames: tuple[Frame, ...]
    nodes: tuple[Node, ...]
    ends: EndpointNames
    servo: Servo | None = None

    @cached_property
    def joint_types(self) -> Mapping[str, str]:
        """Return the type of each joint of the devices."""
        return {joint.name: joint.type for device in self.devices for joint in device.joints}

    def source(self, node: str, interface: str, path: YamlPath) -> Endpoint:
        """Return the end that publishes or serves, by its name in the spec or its full name."""
        return self._end(node, interface, path, serves=True)

    def sink(self, node: str, interface: str, path: YamlPath) -> Endpoint:
        """Return the end that subscribes or is a client, by its name in the spec or its full name."""
        return self._end(node, interface, path, serves=False)

    def driver(self, device: str, node: str, interface: str, path: YamlPath) -> Endpoint:
        """Return the end of a driver's node, which runs on the real target alone."""
        return replace(self.source(device, interface, path), full_name=node, targets=("real",))

    def _end(self, node: str, interface: str, path: YamlPath, *, serves: bool) -> Endpoint:
        """Return an end; one that nothing has is reported elsewhere."""
        known = self.ends.known.get(node, EndName(node, f"/{node.lstrip('/')}", UNKNOWN))
        return known.end(interface, path, self.document.locate(path), serves=serves)

    def planners(self) -> tuple[tuple[str, YamlPath], ...]:
        """Return the nodes that command a controller's motion, each with the place where that is written."""
        paths: dict[str, YamlPath] = {}
        for manager in self.managers:
            for controller in manager.controllers:
                if controller.client is not None:
                    paths.setdefault(controller.client, (*controller.path, "client"))
        return tuple(paths.items())


def with_derived(source: Derivation, written: tuple[Interface, ...]) -> tuple[Interface, ...]:
    """Return the interfaces of the user, then those of controllers, TF and the description, with all who publish them.

    A program that is known to publish on one of them does so whether the spec says it or not.
    """
    known = {interface.name for interface in written}
    controlled = (*control_interfaces(source), *_servoed(source))
    derived = [*_tf(source), *_descriptions(source), *joint_states(source), *controlled]
    together = (*written, *(interface for interface in derived if interface.name not in known))
    unsaid = dict(_unsaid(source))
    return tuple(_with_publishers(interface, unsaid.get(interface.name, ())) for interface in together)


def _unsaid(source: Derivation) -> Iterator[tuple[str, tuple[Endpoint, ...]]]:
    """Yield topics with the nodes of the spec that publish on them by the program that they run."""
    nodes: dict[str, list[Endpoint]] = {}
    for node in source.nodes:
        for topic in source.ends.known[node.full_name].publishes if node.source is NodeSource.SPEC else ():
            nodes.setdefault(topic, []).append(source.source(node.full_name, topic, node.path))
    yield from ((topic, tuple(ends)) for topic, ends in nodes.items())


def _with_publishers(interface: Interface, further: tuple[Endpoint, ...]) -> Interface:
    said = {end.full_name for end in interface.sources}
    unsaid = tuple(end for end in further if end.full_name not in said)
    is_topic = interface.kind is InterfaceKind.TOPIC
    return replace(interface, sources=(*interface.sources, *unsaid)) if unsaid and is_topic else interface


def _tf(source: Derivation) -> Iterator[Interface]:
    path: YamlPath = ("frames",) if source.document.has(("frames",)) else ("devices",)
    publishers = {ROBOT_STATE_PUBLISHER: path}
    for frame in source.frames:
        if frame.kind is FrameKind.DYNAMIC:
            publishers.setdefault(frame.authority, frame.path)
    for name, writers in (("/tf", publishers), ("/tf_static", {ROBOT_STATE_PUBLISHER: path})):
        yield Interface(
            name=name,
            path=path,
            span=source.document.locate(path),
            kind=InterfaceKind.TOPIC,
            type="tf2_msgs/msg/TFMessage",
            sources=tuple(source.source(node, name, at) for node, at in writers.items()),
            sinks=tuple(source.sink(node, name, at) for node, at in source.planners()),
            derived=True,
            unit="m",
            time_source="ros",
            owner=source.spec.owners.responsibilities.frames,
            wants="every_sample",
            on_stale="reject_goal",
        )


def _descriptions(source: Derivation) -> Iterator[Interface]:
    """Yield the description that managers take their hardware from: the cell's, or of several each its own."""
    path: YamlPath = ("devices",)
    alone = source.managers if len(source.managers) == 1 else ()
    listeners = tuple(source.sink(manager.node, DESCRIPTION, manager.path) for manager in alone)
    publisher = source.source(ROBOT_STATE_PUBLISHER, DESCRIPTION, path)
    yield _description(source, DESCRIPTION, path, publisher, listeners)
    for manager in source.managers if not alone else ():
        yield _own_description(source, manager)


def _own_description(source: Derivation, manager: ControllerManager) -> Interface:
    home = description_home(manager)
    name = f"{home}{DESCRIPTION}"
    publisher = source.source(f"{home}/{DESCRIPTION_PUBLISHER}", name, manager.path)
    listener = source.sink(manager.node, name, manager.path)
    return _description(source, name, manager.path, publisher, (listener,))


def _description(
    source: Derivation, name: str, path: YamlPath, publisher: Endpoint, listeners: tuple[Endpoint, ...]
) -> Interface:
    return Interface(
        name=name,
        path=path,
        span=source.document.locate(path),
        kind=InterfaceKind.TOPIC,
        type="std_msgs/msg/String",
        sources=(publisher,),
        sinks=listeners,
        derived=True,
        owner=source.spec.owners.responsibilities.frames,
        wants="newest",
    )


JOINT_STATE_TYPE = "sensor_msgs/msg/JointState"

JOINT_STATE_MAX_AGE_S = 0.1
"""Joint states older than this feed no plan: 50 periods at 500 Hz, half of the 200 ms in which a cancel must hold."""


def joint_states(source: Derivation) -> Iterator[Interface]:
    """Yield the one topic, where a controller publishes joint states; its rate is that of the slowest manager."""
    broadcasters = [
        (manager, controller)
        for manager in source.managers
        for controller in manager.controllers
        if any(topic.publishes and topic.name == JOINT_STATES for topic in controller.own_topics)
    ]
    if not broadcasters:
        return
    path: YamlPath = broadcasters[0][1].path
    published = (source.source(controller.label, JOINT_STATES, controller.path) for _, controller in broadcasters)
    listeners = ((ROBOT_STATE_PUBLISHER, path), *source.planners())
    yield Interface(
        name=JOINT_STATES,
        path=path,
        span=source.document.locate(path),
        kind=InterfaceKind.TOPIC,
        type=JOINT_STATE_TYPE,
        sources=(*published, *_of_drivers(source)),
        sinks=tuple(source.sink(node, JOINT_STATES, at) for node, at in listeners),
        derived=True,
        unit="rad, rad/s, N m",
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        wants="newest",
        rate_hz=min(_rate_hz(manager, controller) for manager, controller in broadcasters),
        max_age_s=JOINT_STATE_MAX_AGE_S,
        on_stale="reject_goal",
    )


def _rate_hz(manager: ControllerManager, controller: Controller) -> float:
    return controller.update_rate_hz or manager.update_rate_hz


def _of_drivers(source: Derivation) -> Iterator[Endpoint]:
    """Yield the drivers that report joints on the real target, where no component of ros2_control does."""
    for device in source.devices:
        if device.control.driver is not None and device.control.driver.joint_states is not None:
            yield source.driver(device.name, device.control.driver.node, JOINT_STATES, device.path)


def control_interfaces(source: Derivation) -> Iterator[Interface]:
    """Yield the actions of all controllers, and the topics and services of those of one device."""
    for manager in source.managers:
        for controller in manager.controllers:
            yield from _actions(source, controller)
            if controller.behavior in OF_ONE_DEVICE:
                yield from _of_one_device(source, controller)


def _actions(source: Derivation, controller: Controller) -> Iterator[Interface]:
    if controller.action is not None and controller.action_type is not None:
        server = source.source(controller.label, controller.action, controller.path)
        yield _action(source, controller, controller.action, controller.action_type, server, None)
    other = controller.stand_in
    if other is not None and controller.device is not None:
        server = source.driver(controller.device, other.node, other.action, controller.path)
        yield _action(source, controller, other.action, other.action_type, server, other.unit)


def _action(
    source: Derivation, controller: Controller, name: str, type_: str, server: Endpoint, unit: str | None
) -> Interface:
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.ACTION,
        type=type_,
        sources=(server,),
        sinks=_clients(source, controller, name),
        derived=True,
        frame=None,
        unit=unit or _goal_unit(source, controller),
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        goal_time_s=controller.goal_time_s,
        on_error=controller.on_violation,
        cancel_within_s=None if source.spec.kpis.cancel is None else source.spec.kpis.cancel.si,
    )


def _goal_unit(source: Derivation, controller: Controller) -> str:
    """Return the units of a goal's figures: those of the joints, and time or force."""
    lengths = {source.joint_types.get(joint) == "prismatic" for joint in controller.joints}
    if controller.behavior in TRAJECTORIES:
        return ", ".join([*(["rad"] if False in lengths else []), *(["m"] if True in lengths else []), "s"])
    return "m, N" if lengths == {True} else "rad, N m"


def _clients(source: Derivation, controller: Controller, interface: str) -> tuple[Endpoint, ...]:
    """Return the client of a controller; MoveIt Servo streams to its topic, and calls nothing of it."""
    streamed = source.servo is not None and source.servo.controller == controller.full_name
    if controller.client is None or streamed:
        return ()
    return (source.sink(controller.client, interface, (*controller.path, "client")),)


def _servoed(source: Derivation) -> Iterator[Interface]:
    """Yield the topic on which MoveIt Servo commands its controller."""
    servo = source.servo
    named = (controller for manager in source.managers for controller in manager.controllers)
    controller = next(
        (controller for controller in named if servo is not None and controller.full_name == servo.controller), None
    )
    if servo is None or controller is None:
        return
    path: YamlPath = ("motion", "servo")
    yield Interface(
        name=servo.topic,
        path=path,
        span=source.document.locate(path),
        kind=InterfaceKind.TOPIC,
        type=servo.type,
        sources=(source.source(servo.node, servo.topic, (*path, "node")),),
        sinks=(source.sink(controller.label, servo.topic, controller.path),),
        derived=True,
        unit=_goal_unit(source, controller),
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        wants="newest",
    )


def _of_one_device(source: Derivation, controller: Controller) -> Iterator[Interface]:
    kind = controller.declared
    if kind is None:
        return
    for topic in controller.own_topics:
        if topic.publishes or controller.client is not None:  # a missing client is a finding by itself
            yield _topic(source, controller, topic)
    yield from (_service(source, controller, service) for service in kind.services)


def _topic(source: Derivation, controller: Controller, topic: ControllerTopic) -> Interface:
    end = source.source if topic.publishes else source.sink
    ends = (end(controller.label, topic.name, controller.path),)
    return Interface(
        name=topic.name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.TOPIC,
        type=topic.type,
        sources=ends if topic.publishes else _clients(source, controller, topic.name),
        sinks=() if topic.publishes else ends,
        derived=True,
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        wants="newest",
    )


def _service(source: Derivation, controller: Controller, service: ControllerService) -> Interface:
    name = graph_name(controller.namespace, controller.full_name, service.name)
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.SERVICE,
        type=service.type,
        sources=(source.source(controller.label, name, controller.path),),
        sinks=_clients(source, controller, name),
        derived=True,
        owner=source.spec.owners.responsibilities.command,
    )
