"""Interfaces that follow from devices and controllers; the user need not write them, and may."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.control import ControllerManager
from cellc.cell.frame import FrameKind
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.diagnostics import YamlPath
from cellc.link.derivation import Derivation
from cellc.link.derived_control import control_interfaces
from cellc.link.derived_joint_states import joint_states
from cellc.link.frames import ROBOT_STATE_PUBLISHER
from cellc.link.nodes import DESCRIPTION_PUBLISHER, description_home
from cellc.link.qos import LATCHED, TF, TF_STATIC_LISTENER

_DESCRIPTION = "/robot_description"


def derive_interfaces(source: Derivation, written: tuple[Interface, ...]) -> tuple[Interface, ...]:
    """Return the interfaces that the user did not write: controllers' actions and states, TF, the description."""
    known = {interface.name for interface in written}
    derived = [*_tf(source), *_descriptions(source), *joint_states(source), *control_interfaces(source)]
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
