"""The joint states of the cell: one topic, on which every controller manager and driver reports the joints it moves."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.catalog.load import kind_behind
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.diagnostics import YamlPath
from cellc.link.derivation import Derivation
from cellc.link.frames import ROBOT_STATE_PUBLISHER
from cellc.link.nodes import JOINT_STATES
from cellc.link.qos import SENSOR_DATA

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
        if device.driver is not None and device.driver.joint_states is not None:
            qos = source.ends.known[device.name].offered.get(device.driver.joint_states)
            yield source.driver_end(device.name, device.driver.node, JOINT_STATES, device.path, qos)
