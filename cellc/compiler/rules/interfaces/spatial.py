"""Rules on topics that tell of places, and on the frame in which they do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.data_flow import interface_types
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.contract.vocabulary import InterfaceKind

_WITHOUT_PLACE = frozenset({"control_msgs/action/GripperCommand", "control_msgs/action/ParallelGripperCommand"})
"""Actions whose goals are an opening and a force, in no frame."""


@rule(Severity.ERROR)
def command_without_frame(graph: CellGraph) -> Findings:
    """Yield actions of the spec without a frame, apart from those whose goals have no place."""
    for interface in graph.cell.interfaces:
        if interface.type in _WITHOUT_PLACE:
            continue
        if interface.kind is InterfaceKind.ACTION and not interface.derived and interface.frame is None:
            message = f"action `{interface.name}` does not say in which frame its goals are"
            yield found(graph, interface.path, message)


_Stamp = tuple[str, str, YamlPath]


@rule(Severity.ERROR, assumes=("camera-data-in-body-frame",))
def frame_of_another_stamp(graph: CellGraph) -> Findings:
    """Yield interfaces of the spec whose frame is not that of a stream or a broadcaster that publishes them."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.frame is None:
            continue
        for stamped, who, path in _stamps(graph, interface):
            if stamped != interface.frame:
                message = (
                    f"`{interface.name}` is declared in `{interface.frame}`, but `{who}` stamps it with `{stamped}`"
                )
                related = (Related("stamped here", graph.cell.locate(*path)),)
                yield found(graph, (*interface.path, "frame"), message, related=related)
                break


def _stamps(graph: CellGraph, interface: Interface) -> Iterator[_Stamp]:
    """Yield the frame of each publisher that has one, with the name of the publisher and where it says so."""
    for source in interface.sources:
        yield from graph.once(_of_cameras).get((source.node, interface.name), ())
        yield from graph.once(_of_controllers).get(source.node, ())


def _of_cameras(graph: CellGraph) -> Mapping[tuple[str, str], list[_Stamp]]:
    """Return what each device with a camera stamps, by its name and the topic."""
    stamps: dict[tuple[str, str], list[_Stamp]] = {}
    for device in graph.cell.devices:
        for stream in device.sensing.camera.streams if device.sensing.camera is not None else ():
            for topic in dict.fromkeys((stream.topic, stream.info_topic)):
                stamps.setdefault((device.name, topic), []).append((stream.frame, device.name, device.path))
    return stamps


def _of_controllers(graph: CellGraph) -> Mapping[str, list[_Stamp]]:
    stamps: dict[str, list[_Stamp]] = {}
    for controller in graph.cell.controllers:
        frame = controller.parameters.get("frame_id")
        if isinstance(frame, str) and frame:
            path = (*controller.path, "parameters", "frame_id")
            stamps.setdefault(controller.label, []).append((frame, controller.name, path))
    return stamps


_POSES = frozenset(
    {
        "geometry_msgs/msg/PointStamped",
        "geometry_msgs/msg/PoseArray",
        "geometry_msgs/msg/PoseStamped",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
    }
)


@rule(Severity.WARNING, assumes=("camera-data-in-body-frame", "object-under-another-camera"))
def pose_apart_from_its_frame(graph: CellGraph) -> Findings:
    """Yield the poses of a node that publishes frames, where all are said in frames that none of those is in."""
    topics = [
        interface
        for interface in graph.cell.interfaces
        if interface.type in _POSES and not interface.derived and interface.frame is not None
    ]
    published_by: dict[str, set[str | None]] = {}
    for interface in topics:
        for name in _names(interface):
            published_by.setdefault(name, set()).add(interface.frame)
    dynamic = [frame for frame in graph.cell.frames if frame.kind is FrameKind.DYNAMIC]
    for interface in topics:
        names = _names(interface)
        frames = [item for item in dynamic if item.authority in names]
        published = set[str | None]().union(*(published_by[name] for name in names))
        if frames and published.isdisjoint({name for frame in frames for name in (frame.name, frame.parent)}):
            message = (
                f"`{interface.name}` must be in `{frames[0].parent}`, where its node publishes `{frames[0].name}`,"
            )
            related = (Related("the frame of the object", graph.cell.locate(*frames[0].path, "parent")),)
            yield found(graph, (*interface.path, "frame"), f"{message} got `{interface.frame}`", related=related)


def _names(interface: Interface) -> set[str]:
    return {name for source in interface.sources for name in (source.node, source.full_name)}


@rule(Severity.ERROR)
def spatial_topic_without_frame(graph: CellGraph) -> Findings:
    """Yield topics of the spec that carry positions and can move something, without a frame."""
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived or interface.frame is not None:
            continue
        facts = interface_types().get(interface.type)
        if facts is None or not (facts.unit or "").startswith("m"):
            continue
        if facts.feeds_motion or interface.name in graph.data.feeding_motion():
            message = f"`{interface.name}` carries `{interface.type}` but names no frame"
            yield found(graph, interface.path, message)
