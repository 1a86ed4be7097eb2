"""Interfaces that follow from devices and controllers; the user need not write them, and may."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.catalog.controller_kind import ControllerKind
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.frame import Frame, FrameKind
from cellc.cell.interface import Endpoint, Interface, InterfaceKind, Qos
from cellc.diagnostics import Span, YamlPath
from cellc.link.frames import ROBOT_STATE_PUBLISHER
from cellc.link.qos import DEFAULT, LATCHED, SENSOR_DATA, TF, TF_STATIC_LISTENER, QosResolver
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec

JOINT_STATE_MAX_AGE_S = 0.1
"""Joint states older than this feed no plan: 50 periods at 500 Hz, half of the 200 ms in which a cancel must hold."""


@dataclass(frozen=True, slots=True)
class Derivation:
    """What interfaces are derived from."""

    spec: CellSpec
    document: SourceDocument
    managers: tuple[ControllerManager, ...]
    kinds: dict[str, ControllerKind]
    frames: tuple[Frame, ...]
    resolver: QosResolver


def derive_interfaces(source: Derivation, written: tuple[Interface, ...]) -> tuple[Interface, ...]:
    """Return the interfaces that the user did not write: controllers' actions and states, TF, the description."""
    known = {interface.name for interface in written}
    derived = [*_tf(source), *_description(source)]
    for manager in source.managers:
        for controller in manager.controllers:
            derived += [*_action(source, manager, controller), *_joint_states(source, manager, controller)]
    return tuple(interface for interface in derived if interface.name not in known)


def _end(source: Derivation, node: str, path: YamlPath, qos: Qos = DEFAULT) -> Endpoint:
    return Endpoint(node=node, qos=qos, path=path, span=source.document.locate(path))


def _span(source: Derivation, path: YamlPath) -> Span:
    return source.document.locate(path)


def _planners(source: Derivation) -> tuple[tuple[str, YamlPath], ...]:
    """Return the nodes that command a controller's motion, each with the place where that is written."""
    found: dict[str, YamlPath] = {}
    for manager in source.managers:
        for controller in manager.controllers:
            if controller.client is not None:
                found.setdefault(controller.client, (*controller.path, "client"))
    return tuple(found.items())


def _action(source: Derivation, manager: ControllerManager, controller: Controller) -> Iterator[Interface]:
    if controller.action is None or controller.action_type is None:
        return
    path = controller.path
    clients = () if controller.client is None else (_end(source, controller.client, (*path, "client")),)
    yield Interface(
        name=controller.action,
        path=path,
        span=_span(source, path),
        kind=InterfaceKind.ACTION,
        type=controller.action_type,
        sources=(_end(source, controller.name, path),),
        sinks=clients,
        derived=True,
        frame=None,
        unit="rad, s",
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        timeout_s=controller.goal_time_s,
        on_timeout="cancel_and_hold",
        on_error=controller.on_violation,
        cancel_within_s=None if source.spec.kpis.cancel is None else source.spec.kpis.cancel.si,
    )


def _joint_states(source: Derivation, manager: ControllerManager, controller: Controller) -> Iterator[Interface]:
    for topic in source.kinds[controller.behaviour].topics if controller.behaviour in source.kinds else ():
        if topic.direction != "publish" or topic.type != "sensor_msgs/msg/JointState":
            continue
        sinks = (
            _end(source, ROBOT_STATE_PUBLISHER, controller.path, SENSOR_DATA),
            *(_end(source, node, path) for node, path in _planners(source)),
        )
        yield Interface(
            name=f"{manager.namespace}/{topic.name}",
            path=controller.path,
            span=_span(source, controller.path),
            kind=InterfaceKind.TOPIC,
            type=topic.type,
            sources=(_end(source, controller.name, controller.path, source.resolver.writer(topic.qos)),),
            sinks=sinks,
            derived=True,
            unit="rad, rad/s, N m",
            time_source="ros",
            owner=source.spec.owners.responsibilities.command,
            wants="newest",
            rate_hz=controller.update_rate_hz or manager.update_rate_hz,
            max_age_s=JOINT_STATE_MAX_AGE_S,
            on_stale="reject_goal",
        )


def _tf(source: Derivation) -> Iterator[Interface]:
    path: YamlPath = ("frames",) if source.document.has(("frames",)) else ("devices",)
    publishers = {ROBOT_STATE_PUBLISHER: path}
    for frame in source.frames:
        if frame.kind is FrameKind.DYNAMIC:
            publishers.setdefault(frame.authority, frame.path)
    listeners = _planners(source)
    for name, listener, writers in (
        ("/tf", TF, tuple(_end(source, node, at, TF) for node, at in publishers.items())),
        ("/tf_static", TF_STATIC_LISTENER, (_end(source, ROBOT_STATE_PUBLISHER, path, LATCHED),)),
    ):
        yield Interface(
            name=name,
            path=path,
            span=_span(source, path),
            kind=InterfaceKind.TOPIC,
            type="tf2_msgs/msg/TFMessage",
            sources=writers,
            sinks=tuple(_end(source, node, at, listener) for node, at in listeners),
            derived=True,
            unit="m",
            time_source="ros",
            owner=source.spec.owners.responsibilities.frames,
            wants="every_sample",
            on_stale="reject_goal",
        )


def _description(source: Derivation) -> Iterator[Interface]:
    path: YamlPath = ("devices",)
    yield Interface(
        name="/robot_description",
        path=path,
        span=_span(source, path),
        kind=InterfaceKind.TOPIC,
        type="std_msgs/msg/String",
        sources=(_end(source, ROBOT_STATE_PUBLISHER, path, LATCHED),),
        sinks=tuple(_end(source, "controller_manager", manager.path, LATCHED) for manager in source.managers),
        derived=True,
        owner=source.spec.owners.responsibilities.frames,
        wants="newest",
    )
