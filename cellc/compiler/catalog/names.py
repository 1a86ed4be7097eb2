"""Names in a device.yaml that mean something else of it: each is looked up once, as it is read, or reported."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set

from cellc.compiler.catalog.device_graph import QosUse
from cellc.compiler.catalog.device_interfaces import counted
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Severity, YamlPath, did_you_mean, is_slip
from cellc.contract.frozen import dataclass
from cellc.robot.description.model import Description

_EVERY_JOINT = "*"
_ROS = "standard of ros2_control"
_STANDARD = frozenset({"position", "velocity", "acceleration", "effort"})
"""What controllers look for: hardware_interface/types/hardware_interface_type_values.hpp of ros2_control 4.47.0."""
_DRIVER = "driver"  # an end that the device's controllers are, not one of its nodes


@dataclass(frozen=True, slots=True)
class CatalogNames:
    """Names that the catalog has for every device: kinds of controllers, and QoS profiles."""

    kinds: Set[str]
    profiles: Set[str]


@dataclass(frozen=True, slots=True)
class _Reference:
    """Where a name is, what it names, and the names that there are; ``thing`` ends in its plural with an s."""

    path: YamlPath
    name: str
    thing: str
    known: Set[str]
    where: str


def unknown_names(
    model: DeviceModel, description: Description, document: SourceDocument, catalog: CatalogNames
) -> Iterator[Diagnostic]:
    """Yield a finding for each name that nothing has, with the nearest names that exist."""
    for reference in (
        *_of_description(model, description),
        *_of_catalog(model, catalog),
        *_of_device(model),
        *_of_interfaces(model),
    ):
        if reference.name not in reference.known:
            yield Diagnostic(
                "catalog-entry-invalid",
                Severity.ERROR,
                f"the {reference.where} has no {reference.thing} `{reference.name}`",
                document.locate(reference.path),
                reference.path,
                did_you_mean(reference.name, reference.known, f"{reference.thing}s of the {reference.where}"),
            )


def _of_description(model: DeviceModel, description: Description) -> Iterator[_Reference]:
    links = {link.name for link in description.links}
    joints = {joint.name for joint in description.joints}

    def link(path: YamlPath, name: str, short: Set[str] = frozenset()) -> _Reference:
        return _Reference(path, name, "link", links | short, "description")

    yield link(("base",), model.base)
    for name, target in model.frames.items():
        yield link(("frames", name), target)
    shorts = frozenset(model.frames)
    if model.tool_frame is not None:
        yield link(("tool_frame",), model.tool_frame, shorts)
    for number, name in enumerate(model.optical_frames):
        yield link(("optical_frames", number), name, shorts)
    for number, topic in enumerate(model.topics):
        if topic.frame is not None:
            yield link(("topics", number, "frame"), topic.frame)
    if model.camera is not None:
        for name, stream in model.camera.streams.items():
            yield link(("camera", "streams", name, "frame"), stream.frame)
    for number, pair in enumerate(model.allowed_collisions):
        yield from (link(("allowed_collisions", number, "links", place), name) for place, name in enumerate(pair.links))
    for path, name in _joints_named(model):
        if name != _EVERY_JOINT:
            yield _Reference(path, name, "joint", joints, "description")


def _joints_named(model: DeviceModel) -> Iterator[tuple[YamlPath, str]]:
    yield from ((("home", joint), joint) for joint in model.home or {})
    for key, limits in model.limits.of_joints().items():
        yield from ((("limits", key, joint), joint) for joint in limits)
    if model.control is not None:
        yield from ((("control", "joints", joint), joint) for joint in model.control.joints)
    if model.gripper is not None:
        yield ("gripper", "joint"), model.gripper.joint
    if model.kinematics is not None:
        yield from ((("kinematics", "joints", entry), joint) for entry, joint in model.kinematics.joints.items())


def _of_catalog(model: DeviceModel, catalog: CatalogNames) -> Iterator[_Reference]:
    for name, controller in model.controllers.items():
        path = ("controllers", name, "behavior")
        yield _Reference(path, controller.behavior, "kind of controller", catalog.kinds, "catalog")
    for at, use in _profiles_named(model):
        if isinstance(use, str):
            yield _Reference(at, use, "QoS profile", catalog.profiles, "catalog")


def _profiles_named(model: DeviceModel) -> Iterator[tuple[YamlPath, QosUse]]:
    yield from ((("topics", number, "qos"), topic.qos) for number, topic in enumerate(model.topics))
    for name, controller in model.controllers.items():
        for number, published in enumerate(controller.topics):
            yield ("controllers", name, "topics", number, "qos"), published.qos
    if model.camera is not None:
        for name, stream in model.camera.streams.items():
            yield ("camera", "streams", name, "qos"), stream.qos
            yield ("camera", "streams", name, "info_qos"), stream.info_qos


def _of_interfaces(model: DeviceModel) -> Iterator[_Reference]:
    """Yield interfaces of joints that are one slip away from a standard one, and initial values of any."""
    if model.control is None:
        return
    for joint, interfaces in model.control.joints.items():
        for kind, names in (("command", interfaces.command), ("state", interfaces.state)):
            for number, name in enumerate(names):
                if any(is_slip(name, text) for text in _STANDARD):
                    yield _Reference(("control", "joints", joint, kind, number), name, "interface", _STANDARD, _ROS)
    for part, groups in (("sensors", model.control.sensors), ("gpios", model.control.gpios)):
        for name, group in groups.items():
            known = frozenset(counted((*group.command, *group.state)))
            for interface in group.initial:
                yield _Reference(
                    ("control", part, name, "initial", interface), interface, "interface", known, part[:-1]
                )


def _of_device(model: DeviceModel) -> Iterator[_Reference]:
    def own(path: YamlPath, name: str, thing: str, known: Iterable[str]) -> _Reference:
        return _Reference(path, name, thing, frozenset(known), "device")

    nodes = [node.name for node in model.nodes]
    for number, topic in enumerate(model.topics):
        yield own(("topics", number, "publisher"), topic.publisher, "node", (*nodes, _DRIVER))
    for number, service in enumerate(model.services):
        yield own(("services", number, "server"), service.server, "node", (*nodes, _DRIVER))
    for number, action in enumerate(model.actions):
        yield own(("actions", number, "server"), action.server, "node", (*nodes, _DRIVER))
    yield from _of_switched(model)
    driver = model.driver
    if driver is None:
        return
    yield own(("driver", "node"), driver.node, "node", nodes)
    if driver.joint_states is not None:
        topics = (topic.name for topic in model.topics)
        yield own(("driver", "joint_states"), driver.joint_states, "topic", topics)
    for kind, name in driver.actions.items():
        yield own(("driver", "actions", kind), name, "action", (facts.name for facts in model.actions))


def _of_switched(model: DeviceModel) -> Iterator[_Reference]:
    switched = model.switched
    if switched is None:
        return
    for name, state in switched.states.items():
        path: YamlPath = ("switched", "states", name)
        for kind, named, known in (
            ("output", state.outputs, switched.outputs),
            ("sensor", state.sensors, switched.sensors),
        ):
            for signal in named:
                yield _Reference((*path, f"{kind}s", signal), signal, kind, frozenset(known), "device")
    if switched.holds is not None:
        yield _Reference(("switched", "holds"), switched.holds, "state", frozenset(switched.states), "device")
