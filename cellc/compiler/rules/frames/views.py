"""Bounds of what cameras see: distances of depth, the map that is fed from them, and where parts may lie."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.cell.device import CameraStream, Device, FieldOfView
from cellc.compiler.cell.motion import Octomap
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.bounds import Bound, Figure, outside
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, rule
from cellc.contract.transforms import Vector3

_MAP: YamlPath = ("motion", "octomap")
_FARTHER = 1.2
"""What a data sheet calls farthest is no wall."""


def _source(graph: CellGraph, octomap: Octomap) -> tuple[Device, CameraStream, FieldOfView] | None:
    """Return the camera and the stream that a map is made from, directly or in whose frame its cloud is."""
    interface = next((topic for topic in graph.cell.interfaces if topic.name == octomap.source), None)
    for device in graph.cell.devices:
        for stream in () if device.sensing.camera is None else device.sensing.camera.streams:
            mine = interface is not None and interface.frame == stream.frame
            if stream.view is not None and (stream.topic == octomap.source or mine):
                return device, stream, stream.view
    return None


def _ranges(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far the map goes: not beyond what its camera sees, and to the nearest place that is worked at."""
    octomap = graph.cell.octomap
    source = None if octomap is None else _source(graph, octomap)
    if octomap is None or source is None:
        return
    device, stream, view = source
    eye = graph.frames.in_world(stream.frame)
    places = [graph.frames.in_world(goal.frame) for goal in graph.cell.goals]
    ways = [math.dist(eye.position, place.position) for place in places if place is not None and eye is not None]
    related = (Related("the camera is here", graph.cell.locate(*device.path, "mount")),)
    most = _FARTHER * view.farthest_m
    least = min(ways, default=0.0)
    why = f"from the nearest goal to what `{device.name}` sees"
    yield Figure((*_MAP, "range"), octomap.range_m, min(least, most), most, why, related=related)


_COARSEST_M = 0.05


def _cells(graph: CellGraph) -> Iterator[Figure]:
    """Yield the edge of the cells of the map, which twice the width of the narrowest part bounds."""
    octomap = graph.cell.octomap
    parts = {
        frame.name: frame.grasp.width_m
        for frame in graph.cell.frames
        if frame.grasp is not None and frame.grasp.width_m is not None
    }
    if octomap is not None:
        most = max(_COARSEST_M, 2.0 * min(parts.values(), default=math.inf))
        narrowest = min(parts, key=lambda name: parts[name], default="")
        related = (Related("the narrowest part", graph.cell.locate("frames", narrowest, "grasp")),) if parts else ()
        yield Figure((*_MAP, "resolution"), octomap.resolution_m, most=min(most, 0.1), related=related)


def _padding(graph: CellGraph) -> Iterator[Figure]:
    octomap = graph.cell.octomap
    if octomap is not None:
        yield Figure((*_MAP, "padding"), octomap.padding_m, 0.005)


def _depths(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far parts are from the imager of a depth stream that somebody reads, where they are detected."""
    read = {interface.name for interface in graph.cell.interfaces if interface.sinks}
    for view in motion_answer(graph).views:
        for device in graph.cell.devices:
            streams = () if device.sensing.camera is None else device.sensing.camera.streams
            if view.camera_frame not in [stream.frame for stream in streams]:
                continue
            for stream in (stream for stream in streams if stream.topic in read and stream.view is not None):
                away = _ahead(graph, device, view.camera_frame, view.place, stream.frame)
                if away is not None and stream.view is not None and stream.frame != view.camera_frame:
                    why = f"as `{stream.topic}` sees it, with `{view.name}` in front"
                    place = graph.cell.locate("frames", view.name, "simulated_pose")
                    near, far = stream.view.nearest_m, stream.view.farthest_m
                    related = (Related("what is detected", place),)
                    yield Figure((*device.path, "mount"), away, near, far, why, related=related)


def _ahead(graph: CellGraph, device: Device, frame: str, place: Vector3, other: str) -> float | None:
    """Return how far along the axis of another imager a place is, that is known in the frame of one, m."""
    root = device.body.root_link
    one, two = graph.frames.pose_in(frame, root, rigid=True), graph.frames.pose_in(other, root, rigid=True)
    return None if one is None or two is None else (two.inverse() @ one).apply(place)[2]


def _regions(graph: CellGraph) -> Iterator[Figure]:
    """Yield how wide the places are in which a part may lie, which the view of its camera bounds there."""
    uncertainty = graph.cell.uncertainty
    regions = {} if uncertainty is None else uncertainty.regions
    for view in motion_answer(graph).views if regions else ():
        region, field = regions.get(view.name), _field(graph, view.camera_frame)
        if region is not None and field is not None and view.place[2] > 0.0:
            seen = 2.0 * view.place[2] * math.tan(min(max(field.horizontal, field.vertical), 3.0) / 2.0)
            why = f"what its camera sees at {view.place[2]:.3g} m"
            yield Figure(("regions", view.name, "box"), 2.0 * max(region.half_m), most=_FARTHER * seen, because=why)


def _field(graph: CellGraph, frame: str) -> FieldOfView | None:
    for device in graph.cell.devices:
        for stream in () if device.sensing.camera is None else device.sensing.camera.streams:
            if stream.frame == frame:
                return stream.view
    return None


BOUNDS = (
    Bound(("motion.octomap.range",), "`range`", "m", "", _ranges),
    Bound(
        ("motion.octomap.resolution",), "`resolution`", "mm", "twice the narrowest part, and a tenth of a meter", _cells
    ),
    Bound(("motion.octomap.padding",), "`padding`", "mm", "above the noise of depth", _padding),
    Bound(("regions.*.box",), "the range of the part", "m", "", _regions),
)
DISTANCES = (Bound(("devices.*.mount.xyz",), "the distance along the axis of the camera", "m", "", _depths),)


@rule(
    Severity.WARNING,
    assumes=(*KNOWN_GOALS, "detached-mount", "object-out-of-view", "implausible-size"),
    gives_way=True,
)
def implausible_view(graph: CellGraph) -> Findings:
    """Yield maps, distances and regions that the cameras of the cell do not see."""
    yield from outside(graph, (*BOUNDS, *DISTANCES))
