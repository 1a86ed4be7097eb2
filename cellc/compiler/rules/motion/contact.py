"""Rules on what touches what."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.motion import DEPTH_IMAGE, POINT_CLOUD, Octomap
from cellc.compiler.feasibility import BodyContact, motion_answer
from cellc.compiler.feasibility.answers import PoseAnswer
from cellc.compiler.rules.geometry import (
    KNOWN_GOALS,
    KNOWN_POSES,
    SOUND_MODEL,
    USABLE_MESHES,
    in_the_chain,
    mounts,
    named,
    things,
    with_scene,
    within_robot,
)
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def goal_in_collision(graph: CellGraph) -> Findings:
    """Yield goals whose every solution is in collision, with what touches in the one nearest to the start."""
    paths = {goal.name: goal.path for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.failure == "goal_in_collision":
            message = f"at goal `{goal.name}` {goal.detail}"
            related = (*in_the_chain(graph, goal.name), *things(graph, goal.detail))
            yield found(graph, (*paths[goal.name], "frame"), message, related=related)


_WIDER_M = 0.15
"""A gripper may stand with open fingers astride what is narrower than this."""
_SURFACE_M = 0.002


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, "goal-in-collision", "infeasible-approach"))
def goal_inside_scene(graph: CellGraph) -> Findings:
    """Yield goals whose tip is inside a box of the scene that no gripper spans."""
    for goal in graph.cell.goals:
        place = graph.frames.in_world(goal.frame)
        for box in graph.cell.scene if place is not None else ():
            parent = graph.frames.in_world(box.parent)
            if place is None or parent is None or sorted(box.size)[1] < _WIDER_M:
                continue
            deep_m = box.depth_m((parent.inverse() @ place @ goal.transform_tip_to_frame).position)
            if deep_m is not None and deep_m > _SURFACE_M:
                message = f"goal `{goal.name}` must lie outside of `{box.name}`, got {deep_m * 1e3:.3g} mm within it"
                related = (Related("the box", box.span), Related("its frame", graph.cell.locate("frames", goal.frame)))
                yield found(graph, goal.path, message, related=related)
                break


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def link_inside_scene(graph: CellGraph) -> Findings:
    """Yield boxes of the scene that are out of the check against links that move towards and away from them."""
    unchecked = with_scene(graph, motion_answer(graph).rigid)
    for box in graph.cell.scene:
        contacts = [
            contact
            for contact in unchecked
            if box.name in (contact.first, contact.second) and _moves(graph, box.parent, _other(contact, box.name))
        ]
        if contacts:
            links = ", ".join(f"`{_other(contact, box.name)}`" for contact in contacts)
            message = f"`{box.name}` touches {links} in every posture, so this contact is not checked"
            yield found(graph, box.path, message, related=mounts(graph, contacts))


def _other(contact: BodyContact, name: str) -> str:
    return contact.second if contact.first == name else contact.first


def _moves(graph: CellGraph, parent: str, link: str) -> bool:
    """Tell whether a joint moves a link against what carries a box."""
    return _joints(graph, parent) != _joints(graph, link)


def _joints(graph: CellGraph, name: str) -> Sequence[str]:
    return [frame.name for frame in graph.frames.chain(name) if frame.moving]


@rule(Severity.ERROR, assumes=KNOWN_POSES)
def pose_in_collision_with_scene(graph: CellGraph) -> Findings:
    """Yield each pose in which a link touches a box of the scene."""
    for pose, path in _poses(graph):
        contacts = with_scene(graph, pose.contacts)
        if contacts:
            message = named(contacts)
            yield found(graph, path, f"in pose `{pose.name}` {message}", related=things(graph, message))


@rule(Severity.ERROR, assumes=KNOWN_POSES)
def pose_in_self_collision(graph: CellGraph) -> Findings:
    """Yield each pose in which links touch links."""
    for pose, path in _poses(graph):
        contacts = within_robot(graph, pose.contacts)
        if contacts:
            message = f"in pose `{pose.name}` {named(contacts)}"
            yield found(graph, path, message, related=mounts(graph, contacts))


def _poses(graph: CellGraph) -> Iterator[tuple[PoseAnswer, YamlPath]]:
    """Yield what is known of each named pose, with the place of the first of its name."""
    paths = {pose.name: pose.path for pose in reversed(graph.cell.poses)}
    for pose in motion_answer(graph).poses:
        yield pose, paths[pose.name]


@rule(Severity.WARNING, assumes=KNOWN_POSES)
def start_in_collision(graph: CellGraph) -> Findings:
    """Yield a start in which something touches, where no pose `home` says so already."""
    contacts = motion_answer(graph).start
    if contacts and all(pose.name != "home" for pose in graph.cell.poses):
        message = f"at the start of the cell {named(contacts)}"
        yield found(graph, ("motion", "poses"), message, related=things(graph, message))


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, *USABLE_MESHES, "geometry-too-large"))
def unchecked_geometry(graph: CellGraph) -> Findings:
    """Yield the reason for which the description is refused."""
    refused = motion_answer(graph).refused
    if refused:
        message = f"poses and goals are not checked: {refused}"
        yield found(graph, ("motion", "groups"), message)


_PLANNER = ("moveit_ros_move_group", "move_group")


@rule(Severity.ERROR)
def unfed_octomap(graph: CellGraph) -> Findings:
    """Yield a map without a planner, without data, or whose data the planner does not hear."""
    octomap = graph.cell.octomap
    if octomap is None:
        return
    path = ("motion", "octomap", "source")
    if (color := _color(graph, octomap)) is not None:
        yield found(graph, path, f"`{octomap.source}` must be a depth image, got one of color, `{color}`")
        return
    planners = {node.name for node in graph.cell.nodes if (node.package, node.executable) == _PLANNER}
    if not planners:
        yield found(graph, path, "the occupancy map needs a node that runs move_group")
        return
    topics = {interface.name: interface for interface in graph.cell.interfaces}
    for name in _needed(octomap, topics):
        if message := _absent(name, name == octomap.source, topics.get(name), planners):
            places = [("the topic is here", ("interfaces", name, key)) for key in ("to", "topic") if name in topics]
            related = tuple(Related(text, graph.cell.locate(*place)) for text, place in places)
            yield found(graph, path, message, related=related)
            return


_DEPTH = ("16UC1", "32FC1", "mono16")


def _color(graph: CellGraph, octomap: Octomap) -> str | None:
    """Return the encoding of the source where it is a stream of a camera that has no depth."""
    cameras = (device.sensing.camera for device in graph.cell.devices)
    streams = (stream for camera in cameras if camera is not None for stream in camera.streams)
    source = next((stream for stream in streams if stream.topic == octomap.source), None)
    return None if source is None or source.encoding in _DEPTH else source.encoding


def _absent(name: str, is_source: bool, heard: Interface | None, planners: set[str]) -> str:
    """Return what keeps a topic from the map; empty where it is heard."""
    if heard is None:
        return f"the occupancy map needs `{name}`, which must be an interface of this cell"
    if is_source and heard.type not in (DEPTH_IMAGE, POINT_CLOUD):
        return f"`{name}` must be a depth image or a point cloud, got {heard.type}"
    listens = planners & {end.node for end in heard.sinks}
    return "" if listens else f"`{name}` must have {' or '.join(sorted(planners))} in its `to`"


def _needed(octomap: Octomap, topics: dict[str, Interface]) -> Iterator[str]:
    """Yield the source, and the camera info that a depth image needs."""
    yield octomap.source
    source = topics.get(octomap.source)
    if source is not None and source.type == DEPTH_IMAGE:
        yield f"{octomap.source.rpartition('/')[0]}/camera_info"
