"""Interfaces that follow from devices and controllers; the user need not write them, and may.

TF and the description first, then the joint states of the cell, then what controllers execute, publish and serve.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property

from cellc.compiler.catalog.controller_kind import ControllerService, ControllerTopic
from cellc.compiler.catalog.load import kind_behind
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Frame, FrameKind
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.cell.motion import Servo
from cellc.compiler.link.endpoints import (
    LATCHED,
    SENSOR_DATA,
    TF,
    TF_STATIC_LISTENER,
    EndName,
    EndpointNames,
    QosResolver,
)
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.compiler.link.hardware import JOINT_STATES
from cellc.compiler.link.nodes import DESCRIPTION_PUBLISHER, description_home
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.contract.diagnostics import YamlPath
from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import OF_ONE_DEVICE, TRAJECTORIES, UNKNOWN, Distro, InterfaceKind


# Without slots, so that what is asked for each controller is looked up once and kept.
@dataclass(frozen=True)
class Derivation:
    """The linked parts of a cell that bring interfaces along."""

    spec: CellSpec
    document: SourceDocument
    distro: Distro
    managers: tuple[ControllerManager, ...]
    devices: tuple[Device, ...]
    frames: tuple[Frame, ...]
    ends: EndpointNames
    resolver: QosResolver
    servo: Servo | None = None

    @cached_property
    def joint_types(self) -> Mapping[str, str]:
        """Return the type of each joint of the devices."""
        return {joint.name: joint.type for device in self.devices for joint in device.joints}

    def end(self, node: str, interface: str, path: YamlPath, qos: Qos | None = None) -> Endpoint:
        """Return an end by its name in the spec or its full name; one that nothing has is reported elsewhere."""
        known = self.ends.known.get(node, EndName(node, f"/{node.lstrip('/')}", UNKNOWN))
        return known.end(interface, path, self.document.locate(path), qos)

    def driver_end(self, device: str, node: str, interface: str, path: YamlPath, qos: Qos | None = None) -> Endpoint:
        """Return the end of a driver's node, which runs on the real target alone."""
        return replace(self.end(device, interface, path, qos), full_name=node, targets=("real",))

    def planners(self) -> tuple[tuple[str, YamlPath], ...]:
        """Return the nodes that command a controller's motion, each with the place where that is written."""
        paths: dict[str, YamlPath] = {}
        for manager in self.managers:
            for controller in manager.controllers:
                if controller.client is not None:
                    paths.setdefault(controller.client, (*controller.path, "client"))
        return tuple(paths.items())


_DESCRIPTION = "/robot_description"


def derive_interfaces(source: Derivation, written: tuple[Interface, ...]) -> tuple[Interface, ...]:
    """Return the interfaces that the user did not write: controllers' actions and states, TF, the description."""
    known = {interface.name for interface in written}
    controlled = (*control_interfaces(source), *_servoed(source))
    derived = [*_tf(source), *_descriptions(source), *joint_states(source), *controlled]
    return tuple(interface for interface in derived if interface.name not in known)


def _tf(source: Derivation) -> Iterator[Interface]:
    path: YamlPath = ("frames",) if source.document.has(("frames",)) else ("devices",)
    publishers = {ROBOT_STATE_PUBLISHER: path}
    for frame in source.frames:
        if frame.kind is FrameKind.DYNAMIC:
            publishers.setdefault(frame.authority, frame.path)
    for name, listener, writers in (
        ("/tf", TF, tuple(source.end(node, "/tf", at, TF) for node, at in publishers.items())),
        ("/tf_static", TF_STATIC_LISTENER, (source.end(ROBOT_STATE_PUBLISHER, "/tf_static", path, LATCHED),)),
    ):
        yield Interface(
            name=name,
            path=path,
            span=source.document.locate(path),
            kind=InterfaceKind.TOPIC,
            type="tf2_msgs/msg/TFMessage",
            sources=writers,
            sinks=tuple(source.end(node, name, at, listener) for node, at in source.planners()),
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
    listeners = tuple(source.end(manager.node, _DESCRIPTION, manager.path, LATCHED) for manager in alone)
    publisher = source.end(ROBOT_STATE_PUBLISHER, _DESCRIPTION, path, LATCHED)
    yield _description(source, _DESCRIPTION, path, publisher, listeners)
    for manager in source.managers if not alone else ():
        yield _own_description(source, manager)


def _own_description(source: Derivation, manager: ControllerManager) -> Interface:
    home = description_home(manager)
    name = f"{home}{_DESCRIPTION}"
    publisher = source.end(f"{home}/{DESCRIPTION_PUBLISHER}", name, manager.path, LATCHED)
    listener = source.end(manager.node, name, manager.path, LATCHED)
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
        (manager, controller, end)
        for manager in source.managers
        for controller in manager.controllers
        for end in _published(source, controller)
    ]
    if not broadcasters:
        return
    path: YamlPath = broadcasters[0][1].path
    listeners = ((ROBOT_STATE_PUBLISHER, path, SENSOR_DATA), *((node, at, None) for node, at in source.planners()))
    yield Interface(
        name=JOINT_STATES,
        path=path,
        span=source.document.locate(path),
        kind=InterfaceKind.TOPIC,
        type=JOINT_STATE_TYPE,
        sources=(*(end for _, _, end in broadcasters), *_of_drivers(source)),
        sinks=tuple(source.end(node, JOINT_STATES, at, qos) for node, at, qos in listeners),
        derived=True,
        unit="rad, rad/s, N m",
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        wants="newest",
        rate_hz=min(_rate_hz(manager, controller) for manager, controller, _ in broadcasters),
        max_age_s=JOINT_STATE_MAX_AGE_S,
        on_stale="reject_goal",
    )


def _rate_hz(manager: ControllerManager, controller: Controller) -> float:
    return controller.update_rate_hz or manager.update_rate_hz


def _published(source: Derivation, controller: Controller) -> Iterator[Endpoint]:
    kind = kind_behind(controller.kind, None)
    for topic in () if kind is None else kind.topics:
        if topic.direction == "publish" and topic.type == JOINT_STATE_TYPE:
            yield source.end(controller.label, JOINT_STATES, controller.path, source.resolver.writer(topic.qos))


def _of_drivers(source: Derivation) -> Iterator[Endpoint]:
    """Yield the drivers that report joints on the real target, where no component of ros2_control does."""
    for device in source.devices:
        if device.control.driver is not None and device.control.driver.joint_states is not None:
            qos = source.ends.known[device.name].offered.get(device.control.driver.joint_states)
            yield source.driver_end(device.name, device.control.driver.node, JOINT_STATES, device.path, qos)


def control_interfaces(source: Derivation) -> Iterator[Interface]:
    """Yield the actions of all controllers, and the topics and services of those of one device."""
    for manager in source.managers:
        for controller in manager.controllers:
            yield from _actions(source, controller)
            if controller.behavior in OF_ONE_DEVICE:
                yield from _of_one_device(source, controller)


def _actions(source: Derivation, controller: Controller) -> Iterator[Interface]:
    if controller.action is not None and controller.action_type is not None:
        server = source.end(controller.label, controller.action, controller.path)
        yield _action(source, controller, controller.action, controller.action_type, server, None)
    other = controller.stand_in
    if other is not None and controller.device is not None:
        server = source.driver_end(controller.device, other.node, other.action, controller.path)
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
    return (source.end(controller.client, interface, (*controller.path, "client")),)


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
    qos = source.resolver.writer("system_default"), source.resolver.reader("system_default")
    yield Interface(
        name=servo.topic,
        path=path,
        span=source.document.locate(path),
        kind=InterfaceKind.TOPIC,
        type=servo.type,
        sources=(source.end(servo.node, servo.topic, (*path, "node"), qos[0]),),
        sinks=(source.end(controller.label, servo.topic, controller.path, qos[1]),),
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
    for topic in kind.topics:
        ends = topic.direction == "publish" or controller.client is not None  # a missing client is a finding by itself
        if ends and (not topic.only or source.distro in topic.only):
            yield _topic(source, controller, topic)
    yield from (_service(source, controller, service) for service in kind.services)


def _topic(source: Derivation, controller: Controller, topic: ControllerTopic) -> Interface:
    name = _absolute(controller, topic.name)
    said = topic.direction == "publish"
    qos = source.resolver.writer(topic.qos) if said else source.resolver.reader(topic.qos)
    ends = (source.end(controller.label, name, controller.path, qos),)
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.TOPIC,
        type=topic.type,
        sources=ends if said else _clients(source, controller, name),
        sinks=() if said else ends,
        derived=True,
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        wants="newest",
    )


def _service(source: Derivation, controller: Controller, service: ControllerService) -> Interface:
    name = _absolute(controller, service.name)
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.SERVICE,
        type=service.type,
        sources=(source.end(controller.label, name, controller.path),),
        sinks=_clients(source, controller, name),
        derived=True,
        owner=source.spec.owners.responsibilities.command,
    )


def _absolute(controller: Controller, name: str) -> str:
    """Return a name of the catalog in full: below the controller's own, or in its namespace."""
    return f"{controller.full_name}{name[1:]}" if name.startswith("~/") else f"{controller.namespace}/{name}"
