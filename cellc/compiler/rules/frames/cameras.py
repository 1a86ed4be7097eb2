"""Rules on where cameras look, and in which frame they say what they see."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from cellc.compiler.cell.device import CameraStream, Device, FieldOfView
from cellc.compiler.cell.frame import FrameKind, Solid
from cellc.compiler.feasibility import ViewAnswer, motion_answer
from cellc.compiler.graph.neighbors import Neighbors
from cellc.compiler.rules.described import described
from cellc.compiler.rules.geometry import KNOWN_GOALS, placed_by
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.transforms import Pose, Vector3
from cellc.contract.vocabulary import InterfaceKind

_IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo")


@rule(Severity.ERROR)
def camera_data_in_body_frame(graph: CellGraph) -> Findings:
    """Yield image topics of a camera in a frame other than its optical ones."""
    cameras = {device.name: device for device in graph.cell.devices if device.body.optical_frames}
    for interface in graph.cell.interfaces:
        source = next((cameras[end.node] for end in interface.sources if end.node in cameras), None)
        if source is None or interface.frame is None or interface.type not in _IMAGES:
            continue
        optical = {source.body.frames[name] for name in source.body.optical_frames}
        if interface.frame not in optical:
            message = f"`{interface.name}` carries images in `{interface.frame}`, which is not an optical frame"
            names = ", ".join(f"`{source.name}/{name}`" for name in source.body.optical_frames)
            yield found(graph, (*interface.path, "frame"), message, f"use one of {names}")


_SLACK_RAD = math.radians(15.0)
"""A thing may be this far outside the view: one point represents all of it."""
_PLACED = (FrameKind.FIXED, FrameKind.SCENE, FrameKind.DYNAMIC)


@rule(Severity.WARNING, assumes=("frame-cycle", "implausible-distance", "detached-mount", "turned-optical-frame"))
def camera_sees_nothing(graph: CellGraph) -> Findings:
    """Yield cameras that no joint moves and that have no frame, box or device before them, where there are places."""
    for device in graph.cell.devices:
        streams = () if device.sensing.camera is None else device.sensing.camera.streams
        eyes = [(stream, eye) for stream in streams if (eye := graph.frames.in_world(stream.frame)) is not None]
        things = graph.once(_things) if eyes else ()
        if not things or any(_sees_any(graph, device, stream, eye) for stream, eye in eyes):
            continue
        aside_deg = math.degrees(min(_aside(place) for place in _before(graph, *eyes[0])))
        message = f"`{device.name}` must look at something of the cell, but the nearest lies {aside_deg:.0f} deg"
        yield found(graph, (*device.path, "mount"), f"{message} beside its axis")


def _things(graph: CellGraph) -> list[Vector3]:
    """Return where frames and boxes of the scene stand in the world, m, as far as no joint moves them."""
    frames = (graph.frames.in_world(frame.name) for frame in graph.cell.frames if frame.kind in _PLACED)
    corners = (corner for box in graph.cell.scene for corner in _corners(graph, box))
    return [*(frame.position for frame in frames if frame is not None), *corners]


_CUBE_M = 5.0
"""How far cameras of cells see."""


def _visible(graph: CellGraph) -> Neighbors[str]:
    """Return these places, and with their names those of the devices, as far as no joint moves them."""
    mounts = (frame for frame in graph.cell.frames if frame.kind is FrameKind.MOUNT)
    placed = ((graph.frames.in_world(frame.name), frame.device or "") for frame in mounts)
    devices = ((pose.position, device) for pose, device in placed if pose is not None)
    return Neighbors(((*((place, "") for place in graph.once(_things)), *devices)), _CUBE_M)


def _sees_any(graph: CellGraph, camera: Device, stream: CameraStream, eye: Pose) -> bool:
    """Whether a thing, or another device, is before a camera."""
    world_in_eye = eye.inverse()
    near = graph.once(_visible).within(_farthest_m(stream), of=eye.position)
    return any(device != camera.name and _sees(stream, world_in_eye.apply(place)) for place, device in near)


def _before(graph: CellGraph, stream: CameraStream, eye: Pose) -> list[Vector3]:
    """Return things that a camera is near enough to see, in its frame; all where it is near none."""
    world_in_eye = eye.inverse()
    near = graph.once(_visible).within(_farthest_m(stream), of=eye.position)
    seen = [place for place, device in near if not device]
    return [world_in_eye.apply(place) for place in seen or graph.once(_things)]


def _farthest_m(stream: CameraStream) -> float:
    return math.inf if stream.view is None else stream.view.farthest_m


def _corners(graph: CellGraph, box: Solid) -> Iterator[Vector3]:
    """Yield corners, middles of edges and sides, and the center of a box in the world."""
    parent = graph.frames.in_world(box.parent)
    if parent is None:
        return
    center = parent @ box.transform_to_parent @ box.center
    for signs in itertools.product((-0.5, 0.0, 0.5), repeat=3):
        x, y, z = (sign * length for sign, length in zip(signs, box.size, strict=True))
        yield (center @ Pose((x, y, z), (0.0, 0.0, 0.0, 1.0))).position


def _sees(stream: CameraStream, thing: Vector3) -> bool:
    """Whether a place in the frame of a camera, m, is within its view."""
    x, y, z = thing
    if z <= 0.0 or stream.view is None:
        return z > 0.0
    aside, above = math.atan2(abs(x), z), math.atan2(abs(y), z)
    within = aside <= stream.view.horizontal / 2 + _SLACK_RAD and above <= stream.view.vertical / 2 + _SLACK_RAD
    return within and math.hypot(x, y, z) <= stream.view.farthest_m


def _aside(thing: Vector3) -> float:
    """Return the angle between the axis of a camera and a place in its frame, rad."""
    x, y, z = thing
    return math.atan2(math.hypot(x, y), z)


"""A real object lies somewhere near where the mock has it."""


@rule(Severity.WARNING, assumes=(*KNOWN_GOALS, "detached-mount"))
def object_out_of_view(graph: CellGraph) -> Findings:
    """Yield objects that are out of the field of view, or out of the distances, of their camera, one for an object."""
    frames = {frame.name: frame for frame in graph.cell.frames}
    reported: set[str] = set()
    for view in motion_answer(graph).views:
        camera = next(device for device in graph.cell.devices if view.camera_frame in device.body.frames.values())
        wrong = _out_of_view(view, _field_of_view(camera, view.camera_frame))
        if wrong and view.name not in reported:
            reported.add(view.name)
            where = f"in `{view.posture}`" if view.posture else "at the start"
            message = f"`{camera.name}` must see `{view.name}` {where}, where it is detected, but it lies {wrong}"
            place = (*frames[view.name].path, "simulated_pose")
            related: tuple[Related, ...] = (Related("what is detected", graph.cell.locate(*place)),)
            related += placed_by(graph, view.name, view.camera_frame)
            related += enters(graph, "from here", ("motion", "poses", view.posture))
            yield found(graph, (*camera.path, "mount"), message, related=related)


def _field_of_view(camera: Device, frame: str) -> FieldOfView | None:
    streams = () if camera.sensing.camera is None else camera.sensing.camera.streams
    return next((stream.view for stream in streams if stream.frame == frame), None)


def _out_of_view(view: ViewAnswer, field: FieldOfView | None) -> str:
    """Say where an object lies that is not seen; empty where it is seen. Without a field it must lie in front."""
    x, y, z = view.place
    if z <= 0.0:
        return f"{abs(z):.3g} m behind the camera"
    if field is None:
        return ""
    aside, above = math.atan2(abs(x), z), math.atan2(abs(y), z)
    if aside > field.horizontal / 2 + _SLACK_RAD or above > field.vertical / 2 + _SLACK_RAD:
        figures = f"{math.degrees(aside):.0f} deg to the side and {math.degrees(above):.0f} deg above or below the axis"
        return f"{figures} of a view of {math.degrees(field.horizontal):.0f} by {math.degrees(field.vertical):.0f} deg"
    distance = math.hypot(x, y, z)
    if not field.nearest_m <= distance <= field.farthest_m:
        return f"{distance:.3g} m away, which is not between {field.nearest_m:g} m and {field.farthest_m:g} m"
    return ""


@rule(Severity.ERROR)
def object_under_another_camera(graph: CellGraph) -> Findings:
    """Yield dynamic frames under a camera whose publisher hears other cameras, and not this one."""
    cameras = {device.name: device for device in graph.cell.devices if device.sensing.camera is not None}
    owners = {frame: name for name, device in cameras.items() for frame in device.body.frames.values()}
    for frame in graph.cell.frames:
        camera = owners.get(frame.parent)
        if frame.kind is not FrameKind.DYNAMIC or camera is None:
            continue
        heard = {
            source.node: interface
            for interface in graph.cell.interfaces
            if interface.kind is InterfaceKind.TOPIC and any(sink.node == frame.authority for sink in interface.sinks)
            for source in interface.sources
            if source.node in cameras
        }
        if heard and camera not in heard:
            other, interface = next(iter(heard.items()))
            message = (
                f"`{frame.name}` is attached to `{camera}`, but its publisher `{frame.authority}` reads only `{other}`"
            )
            missed = (
                interface
                for interface in graph.cell.interfaces
                if camera in {source.node for source in interface.sources}
            )
            readers = [(interface, "its images"), *((interface, f"the images of `{camera}`") for interface in missed)]
            related = tuple(Related(label, graph.cell.locate(*interface.path, "to")) for interface, label in readers)
            yield found(graph, (*frame.path, "parent"), message, related=related)


_COS_10_DEG = 0.985  # the calibrated mount of an imager is off by a few degrees at most


@rule(Severity.ERROR)
def turned_optical_frame(graph: CellGraph) -> Findings:
    """Yield optical frames whose axes, seen from the root link of their device, are not those of REP-103."""
    for device in graph.cell.devices:
        for name in device.body.optical_frames:
            pose = graph.frames.pose_in(device.body.frames[name], device.body.root_link)
            if pose is not None and not _looks_forward(pose):
                message = f"the axes of `{device.name}/{name}` must be x right, y down, z forward"
                advice = "turn its joint by rpy `-90 0 -90 deg` against the camera's own frame"
                above = [
                    joint.name for joint in device.body.description.joints if joint.child == device.body.frames[name]
                ]
                yield found(graph, (*device.path, "model"), message, advice, described(graph, above))


def _looks_forward(pose: Pose) -> bool:
    turn = Pose((0.0, 0.0, 0.0), pose.quaternion)
    forward, right = turn.apply((0.0, 0.0, 1.0)), turn.apply((1.0, 0.0, 0.0))
    return forward[0] > _COS_10_DEG and -right[1] > _COS_10_DEG
